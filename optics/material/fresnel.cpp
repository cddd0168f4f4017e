#include "optics/material/fresnel.h"

#include <algorithm>
#include <cmath>

namespace lucerna::optics {

namespace {

// Real amplitudes r_s, r_p of a boundary between transparent media; under total internal reflection
// both are 1 in modulus, and g = sqrt(sin_i^2 - eta^2) gives their phases.
struct DielectricAmplitudes {
    double s = 1.0, p = 1.0;
    bool total = false;
    double g = 0.0;
};

DielectricAmplitudes dielectric_amplitudes(double cos_incidence, double eta) {
    // Equal indices: the formula below is 0/0 at grazing incidence.
    if (eta == 1.0) return {.s = 0.0, .p = 0.0};
    // cos_t^2 eta^2 = eta^2 - sin_i^2, written so that it keeps its digits near eta = 1.
    const double cos_t_eta_squared = (eta - 1.0) * (eta + 1.0) + square(cos_incidence);
    if (cos_t_eta_squared <= 0.0) return {.total = true, .g = std::sqrt(-cos_t_eta_squared)};
    const double eta_cos_t = std::sqrt(cos_t_eta_squared);
    // Born and Wolf, Principles of Optics, 7th ed., section 1.5.2, eqs. 21 and 32
    return {
        .s = (cos_incidence - eta_cos_t) / (cos_incidence + eta_cos_t),
        .p = (square(eta) * cos_incidence - eta_cos_t) / (square(eta) * cos_incidence + eta_cos_t)};
}

}  // namespace

FresnelReflectance fresnel_dielectric(double cos_incidence, double eta) {
    const DielectricAmplitudes amplitude = dielectric_amplitudes(cos_incidence, eta);
    return {square(amplitude.s), square(amplitude.p)};
}

FresnelReflectance fresnel_conductor(double cos_incidence, double n, double k) {
    // Born and Wolf, section 14.2, eqs. 14 to 18: with a + ib = sqrt((n + ik)^2 - sin^2)
    const double cos2 = square(cos_incidence);
    const double sin2 = 1.0 - cos2;
    const double real = square(n) - square(k) - sin2;      // of (a + ib)^2
    const double modulus = std::hypot(real, 2.0 * n * k);  // a^2 + b^2
    // a^2 = (modulus + real) / 2; for metals real < 0, and the other form does not cancel.
    const double a2 = real > 0.0 ? 0.5 * (modulus + real)
                                 : 2.0 * square(n * k) / std::max(modulus - real, 1e-300);
    const double twice_a_cos = 2.0 * std::sqrt(a2) * cos_incidence;
    const double s_denominator = modulus + cos2 + twice_a_cos;
    // Only n = 1, k = 0 at grazing incidence: no boundary at all.
    if (s_denominator == 0.0) return {0.0, 0.0};
    const double s = (modulus + cos2 - twice_a_cos) / s_denominator;
    const double even = modulus * cos2 + square(sin2);
    const double p_over_s = (even - twice_a_cos * sin2) / (even + twice_a_cos * sin2);
    return {s, s * p_over_s};
}

Lanes fresnel_dielectric(double cos_incidence, const Lanes& eta) {
    Lanes reflectance;
    for (int k = 0; k < spectral::lane_count; ++k) {
        reflectance[k] = static_cast<float>(
            fresnel_dielectric(cos_incidence, static_cast<double>(eta[k])).unpolarised());
    }
    return reflectance;
}

Lanes fresnel_conductor(double cos_incidence, const Lanes& n, const Lanes& k) {
    Lanes reflectance;
    for (int lane = 0; lane < spectral::lane_count; ++lane) {
        reflectance[lane] =
            static_cast<float>(fresnel_conductor(cos_incidence, static_cast<double>(n[lane]),
                                                 static_cast<double>(k[lane]))
                                   .unpolarised());
    }
    return reflectance;
}

namespace {

template <typename Of>
Mueller<Lanes> on_lanes(const Of& of_lane) {
    Mueller<Lanes> lanes;
    for (int k = 0; k < spectral::lane_count; ++k) {
        const Mueller<double> m = of_lane(k);
        lanes.mean[k] = static_cast<float>(m.mean);
        lanes.difference[k] = static_cast<float>(m.difference);
        lanes.real[k] = static_cast<float>(m.real);
        lanes.imaginary[k] = static_cast<float>(m.imaginary);
    }
    return lanes;
}

}  // namespace

Mueller<double> dielectric_reflection(double cos_incidence, double eta) {
    const DielectricAmplitudes amplitude = dielectric_amplitudes(cos_incidence, eta);
    if (amplitude.total) {
        // r_s r_p* = exp(i delta), tan(delta / 2) = cos g / sin^2: Born and Wolf, section 1.5.4,
        // eq. 60.
        const double sin2 = 1.0 - square(cos_incidence);
        const double cos_g = cos_incidence * amplitude.g;
        const double per_squares = 1.0 / (square(sin2) + square(cos_g));
        return {1.0, 0.0, (square(sin2) - square(cos_g)) * per_squares,
                2.0 * sin2 * cos_g * per_squares};
    }
    const double s = square(amplitude.s);
    const double p = square(amplitude.p);
    return {0.5 * (s + p), 0.5 * (s - p), amplitude.s * amplitude.p, 0.0};
}

Mueller<double> conductor_reflection(double cos_incidence, double n, double k) {
    const FresnelReflectance reflectance = fresnel_conductor(cos_incidence, n, k);
    // With root = a + ib = sqrt((n + ik)^2 - sin^2), which has b >= 0 in a lossy metal,
    // r_p / r_s = (sin^2 - cos root) / (sin^2 + cos root), so that
    // r_s r_p* = R_s (sin^4 - cos^2 |root|^2 + 2i b cos sin^2) / |sin^2 + cos root|^2.
    const double sin2 = 1.0 - square(cos_incidence);
    const double real = square(n) - square(k) - sin2;
    const double modulus = std::hypot(real, 2.0 * n * k);
    const double larger = std::sqrt(0.5 * (modulus + std::abs(real)));
    const double smaller = larger > 0.0 ? n * k / larger : 0.0;
    const double a_cos = (real > 0.0 ? larger : smaller) * cos_incidence;
    const double b_cos = (real > 0.0 ? smaller : larger) * cos_incidence;
    const double factor = reflectance.s / (square(sin2 + a_cos) + square(b_cos));
    return {0.5 * (reflectance.s + reflectance.p), 0.5 * (reflectance.s - reflectance.p),
            factor * (square(sin2) - square(a_cos) - square(b_cos)), factor * 2.0 * b_cos * sin2};
}

Mueller<Lanes> dielectric_reflection(double cos_incidence, const Lanes& eta) {
    return on_lanes([&](int lane) {
        return dielectric_reflection(cos_incidence, static_cast<double>(eta[lane]));
    });
}

Mueller<Lanes> conductor_reflection(double cos_incidence, const Lanes& n, const Lanes& k) {
    return on_lanes([&](int lane) {
        return conductor_reflection(cos_incidence, static_cast<double>(n[lane]),
                                    static_cast<double>(k[lane]));
    });
}

Mueller<double> refraction(const Mueller<double>& reflection) {
    // T_s = 1 - R_s and T_p = 1 - R_p; both amplitudes are real and positive.
    const double s = std::max(0.0, 1.0 - reflection.mean - reflection.difference);
    const double p = std::max(0.0, 1.0 - reflection.mean + reflection.difference);
    return {0.5 * (s + p), 0.5 * (s - p), std::sqrt(s * p), 0.0};
}

Vec3 refract(const Vec3& wo, const Vec3& m, double eta) {
    if (eta == 1.0) return -wo;
    const double cos_i = wo.dot(m);
    const double cos_t = std::sqrt(std::max(0.0, 1.0 - (1.0 - square(cos_i)) / square(eta)));
    return ((cos_i / eta - cos_t) * m - wo / eta).normalized();
}

}  // namespace lucerna::optics
