// A plane-parallel slab in air and a parallel beam of unpolarised light.
#pragma once

#include "validation/truth/fresnel.h"

namespace lucerna::truth {

/// One of the beams that leave the far side of a slab, after 2 * order internal reflections.
struct SlabBeam {
    double transmittance;   ///< of unpolarised light
    double displacement_m;  ///< of the beam's axis, along the part of the slab's normal (taken with
                            ///< the beam) that is perpendicular to the beam
};

/// s and p keep apart, as all planes of incidence coincide.
///   T_k = 1/2 sum over s, p of (1 - R)^2 R^2k a^(2k+1),  a = exp(-alpha d / cos th')
///   D_k = d sin th (1 - cos th / (n cos th')) - 2k d tan th' cos th
/// D_0: Hecht, Optics, 5th ed., problem 4.38; the rest from the path 2k d tan th' along the faces.
inline SlabBeam slab_beam(double index, double incidence_rad, double thickness_m,
                          double absorption_per_m, int order) {
    const Reflection r = reflection(1.0, index, std::cos(incidence_rad));
    const double passage = std::exp(-absorption_per_m * thickness_m / r.cosine_refracted);
    const auto transmittance = [&](double reflectance) {
        return std::pow(1.0 - reflectance, 2) * passage *
               std::pow(reflectance * passage, 2 * order);
    };
    const double sine = std::sin(incidence_rad);
    const double cosine = std::cos(incidence_rad);
    const double sine_refracted = sine / index;
    return {0.5 * (transmittance(r.reflectance_s()) + transmittance(r.reflectance_p())),
            thickness_m * sine * (1.0 - cosine / (index * r.cosine_refracted)) -
                2.0 * order * thickness_m * sine_refracted / r.cosine_refracted * cosine};
}

/// Orders beyond this one carry less than 1e-9 of a beam at up to 80 deg in glass of n <= 2.
inline constexpr int slab_orders = 30;

/// Transmittance in all orders.
inline double slab_transmittance(double index, double incidence_rad, double thickness_m,
                                 double absorption_per_m) {
    double sum = 0.0;
    for (int order = 0; order <= slab_orders; ++order) {
        sum += slab_beam(index, incidence_rad, thickness_m, absorption_per_m, order).transmittance;
    }
    return sum;
}

/// Share of a beam of uniform irradiance and rectangular section that passes the slab and lands
/// where the displacement (see SlabBeam) from the axis of the free beam exceeds `edge_m`.
inline double slab_flux_beyond(double index, double incidence_rad, double thickness_m,
                               double absorption_per_m, double beam_width_m, double edge_m) {
    double sum = 0.0;
    for (int order = 0; order <= slab_orders; ++order) {
        const SlabBeam beam = slab_beam(index, incidence_rad, thickness_m, absorption_per_m, order);
        const double share = 0.5 + (beam.displacement_m - edge_m) / beam_width_m;
        sum += beam.transmittance * std::clamp(share, 0.0, 1.0);
    }
    return sum;
}

}  // namespace lucerna::truth
