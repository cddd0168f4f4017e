#include "optics/material/fresnel.h"

#include <algorithm>
#include <cmath>
#include <complex>

namespace lucerna::optics {

namespace {

double square(double x) {
    return x * x;
}

}  // namespace

FresnelReflectance fresnel_dielectric(double cos_incidence, double eta) {
    // Equal indices: the formula below is 0/0 at grazing incidence.
    if (eta == 1.0) return {0.0, 0.0};
    // cos_t^2 eta^2 = eta^2 - sin_i^2, written so that it keeps its digits near eta = 1.
    const double cos_t_eta_squared = (eta - 1.0) * (eta + 1.0) + square(cos_incidence);
    if (cos_t_eta_squared <= 0.0) return {1.0, 1.0};
    const double eta_cos_t = std::sqrt(cos_t_eta_squared);
    // Born and Wolf, Principles of Optics, 7th ed., section 1.5.2, eqs. 21 and 32
    const double s = (cos_incidence - eta_cos_t) / (cos_incidence + eta_cos_t);
    const double p =
        (square(eta) * cos_incidence - eta_cos_t) / (square(eta) * cos_incidence + eta_cos_t);
    return {square(s), square(p)};
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

Mueller<double> mueller(const FresnelReflectance& reflectance, std::complex<double> s_conj_p) {
    return {0.5 * (reflectance.s + reflectance.p), 0.5 * (reflectance.s - reflectance.p),
            s_conj_p.real(), s_conj_p.imag()};
}

// r_s r_p* of a boundary with the relative index N, where root = sqrt(N^2 - sin^2). From the
// amplitudes of Born and Wolf, section 1.5.2, eq. 21a, with complex angles as in section 14.2.
std::complex<double> amplitude_product(double cosine, std::complex<double> index_squared,
                                       std::complex<double> root) {
    const std::complex<double> s = (cosine - root) / (cosine + root);
    const std::complex<double> p =
        (index_squared * cosine - root) / (index_squared * cosine + root);
    return s * std::conj(p);
}

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
    if (eta == 1.0) return {0.0, 0.0, 0.0, 0.0};
    const double root_squared = (eta - 1.0) * (eta + 1.0) + square(cos_incidence);
    const std::complex<double> root = root_squared > 0.0
                                          ? std::sqrt(root_squared)
                                          : std::complex<double>(0.0, std::sqrt(-root_squared));
    return mueller(fresnel_dielectric(cos_incidence, eta),
                   amplitude_product(cos_incidence, square(eta), root));
}

Mueller<double> conductor_reflection(double cos_incidence, double n, double k) {
    const std::complex<double> index_squared = std::pow(std::complex<double>(n, k), 2);
    const std::complex<double> root = std::sqrt(index_squared - (1.0 - square(cos_incidence)));
    return mueller(fresnel_conductor(cos_incidence, n, k),
                   amplitude_product(cos_incidence, index_squared, root));
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
