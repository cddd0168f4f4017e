// Plane-parallel slabs in air.
#pragma once

#include <cmath>

namespace lucerna::truth {

/// Reflectances of a boundary for s and p polarised light, by the angles of incidence and
/// refraction (Fresnel's sine and tangent laws; Hecht, Optics, 5th ed., eqs. 4.42 and 4.43).
struct Boundary {
    double s, p;
    double mean() const { return 0.5 * (s + p); }
};

inline Boundary boundary(double index, double incidence_rad) {
    if (incidence_rad < 1e-6) {
        const double amplitude = (index - 1.0) / (index + 1.0);
        return {amplitude * amplitude, amplitude * amplitude};
    }
    const double refraction_rad = std::asin(std::sin(incidence_rad) / index);
    const double s =
        std::sin(incidence_rad - refraction_rad) / std::sin(incidence_rad + refraction_rad);
    const double p =
        std::tan(incidence_rad - refraction_rad) / std::tan(incidence_rad + refraction_rad);
    return {s * s, p * p};
}

/// Sum over all internal reflections: T = (1 - R)^2 a / (1 - R^2 a^2), a the transmittance of one
/// passage; for a = 1 it is (1 - R) / (1 + R).
inline double summed_transmittance(double reflectance, double passage) {
    return (1.0 - reflectance) * (1.0 - reflectance) * passage /
           (1.0 - reflectance * reflectance * passage * passage);
}

/// Internal transmittance of one passage under an angle of incidence from air.
inline double passage(double index, double incidence_rad, double thickness_absorption) {
    const double refraction_rad = std::asin(std::sin(incidence_rad) / index);
    return std::exp(-thickness_absorption / std::cos(refraction_rad));
}

/// Transmittance where each boundary is met by unpolarised light. Real light becomes partly
/// polarised at the first boundary; see polarised_transmittance().
inline double unpolarised_transmittance(double index, double incidence_rad,
                                        double thickness_absorption = 0.0) {
    return summed_transmittance(boundary(index, incidence_rad).mean(),
                                passage(index, incidence_rad, thickness_absorption));
}

/// The same with s and p followed apart.
inline double polarised_transmittance(double index, double incidence_rad,
                                      double thickness_absorption = 0.0) {
    const Boundary r = boundary(index, incidence_rad);
    const double a = passage(index, incidence_rad, thickness_absorption);
    return 0.5 * (summed_transmittance(r.s, a) + summed_transmittance(r.p, a));
}

}  // namespace lucerna::truth
