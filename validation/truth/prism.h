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

/// A screen that a beam through a prism meets at right angles where it deviates least.
struct PrismScreen {
    double apex_rad;
    double incidence_rad;
    double least_index;   ///< for which the incidence is that of least deviation
    double entry_m;       ///< from the apex along the face to the axis of the beam
    double screen_m;      ///< from the prism to the screen
    double beam_width_m;  ///< in the principal section, before the prism
};

/// Transmittance and place of a beam of a given index on the screen, measured from where light of
/// least_index lands toward larger deviation.
struct PrismLanding {
    double transmittance;
    double middle_m;
    double width_m;
    /// Share of the beam's flux that passes and lands beyond the middle of the screen.
    double flux_beyond() const {
        return transmittance * std::clamp(0.5 + middle_m / width_m, 0.0, 1.0);
    }
};

/// In the triangle of apex, entry and exit the law of sines gives the place of the exit,
/// entry * cos r1 / cos r2 from the apex; the rest is plane geometry.
inline PrismLanding prism_landing(const PrismScreen& screen, double index) {
    const PrismBeam least = prism_beam(screen.least_index, screen.apex_rad, screen.incidence_rad);
    const PrismBeam beam = prism_beam(index, screen.apex_rad, screen.incidence_rad);
    const double refraction_rad = std::asin(std::sin(screen.incidence_rad) / index);
    const double moved_m =
        screen.entry_m *
        (std::cos(refraction_rad) / std::cos(screen.apex_rad - refraction_rad) - 1.0);
    const double exit_rad = screen.incidence_rad;  // at least deviation: symmetry
    const double turn_rad = beam.deviation_rad - least.deviation_rad;
    return {beam.transmittance,
            moved_m * std::cos(exit_rad) +
                (screen.screen_m - moved_m * std::sin(exit_rad)) * std::tan(turn_rad),
            screen.beam_width_m * beam.widening / std::cos(turn_rad)};
}

}  // namespace lucerna::truth
