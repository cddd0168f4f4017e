// A prism of glass in air and a parallel beam of unpolarised light in its principal section.
#pragma once

#include "validation/truth/fresnel.h"

namespace lucerna::truth {

/// Angle of incidence at which a prism deviates least: i = asin(n sin(A / 2)), the deviation D then
/// obeys n = sin((A + D) / 2) / sin(A / 2) (Born and Wolf, 7th ed., 4.7.2, eq. 37).
inline double least_deviation_incidence_rad(double index, double apex_rad) {
    return std::asin(index * std::sin(0.5 * apex_rad));
}

/// Light that is refracted twice and reflected never.
struct PrismBeam {
    double deviation_rad;
    double transmittance;  ///< of unpolarised light, s and p apart
    double widening;       ///< width of the beam that leaves over that of the beam that enters
};

/// D = i1 + i2 - A,  r1 + r2 = A                         (Born and Wolf, 7th ed., 4.7.2, eqs.
/// 30-32)
inline PrismBeam prism_beam(double index, double apex_rad, double incidence_rad) {
    const double refraction_rad = std::asin(std::sin(incidence_rad) / index);
    const double inner_rad = apex_rad - refraction_rad;
    const double exit_rad = std::asin(index * std::sin(inner_rad));
    const Reflection in = reflection(1.0, index, std::cos(incidence_rad));
    const Reflection out = reflection(index, 1.0, std::cos(inner_rad));
    return {incidence_rad + exit_rad - apex_rad,
            0.5 * ((1.0 - in.reflectance_s()) * (1.0 - out.reflectance_s()) +
                   (1.0 - in.reflectance_p()) * (1.0 - out.reflectance_p())),
            std::cos(refraction_rad) / std::cos(incidence_rad) * std::cos(exit_rad) /
                std::cos(inner_rad)};
}

}  // namespace lucerna::truth
