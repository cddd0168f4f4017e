// A rod of glass as a light guide: where the flux of a Lambertian disk goes.
#pragma once

#include <numbers>
#include <vector>

#include "validation/truth/polarised_ray.h"

namespace lucerna::truth {

/// A cylinder around the z axis from z = 0 to z = length_m, in air, with a Lambertian disk before
/// or at its end at z = 0 that shines along +z, and on whose black face light may return.
struct RodGuide {
    double radius_m;
    double length_m;
    double index;
    double absorption_per_m;
    /// Gap of air between the disk and the end face; 0: the disk lies in the glass, at the end face
    /// and as wide as the rod.
    double gap_m;
    double source_radius_m;  ///< at most radius_m; with a gap of 0 the same
};

/// Shares of the flux that the disk emits.
struct RodFlux {
    double onto_near = 0.0;   ///< meets the near end face from outside
    double far = 0.0;         ///< leaves at z = length_m
    double near = 0.0;        ///< leaves toward -z at z = 0, or returns to the disk in contact
    double sides = 0.0;       ///< leaves through the cylindrical surface
    double absorbed = 0.0;    ///< in the glass
    double unfollowed = 0.0;  ///< rest of rays that were followed no more
};

namespace detail {

/// Follows a ray in the glass from `start` until hardly any flux is left.
inline void follow_in_rod(const RodGuide& rod, Vec3 position, PolarisedRay ray, RodFlux& sum) {
    const double negligible = 1e-9;
    const double start_flux = ray.flux();
    double weight = 1.0;  // what absorption leaves of the fields
    double flux = start_flux;
    while (weight * flux > negligible * start_flux) {
        const Vec3& k = ray.direction;
        // To the cylinder: |position + t k| = radius across the axis, the larger root.
        const double across2 = k.x() * k.x() + k.y() * k.y();
        const double inward = position.x() * k.x() + position.y() * k.y();
        const double depth2 =
            std::max(0.0, rod.radius_m * rod.radius_m - position.x() * position.x() -
                              position.y() * position.y());
        const double to_side_m =
            across2 > 0.0 ? (-inward + std::sqrt(inward * inward + across2 * depth2)) / across2
                          : std::numeric_limits<double>::infinity();
        const double end_m = k.z() > 0.0 ? rod.length_m : 0.0;
        const double to_end_m =
            k.z() != 0.0 ? (end_m - position.z()) / k.z() : std::numeric_limits<double>::infinity();
        const bool side = to_side_m < to_end_m;
        const double length_m = side ? to_side_m : to_end_m;
        const double passed = std::exp(-rod.absorption_per_m * length_m);
        sum.absorbed += weight * flux * (1.0 - passed);
        weight *= passed;
        position += length_m * k;

        if (!side && end_m == 0.0 && rod.gap_m == 0.0) {  // the black face of the disk
            sum.near += weight * flux;
            return;
        }
        Vec3 normal = Vec3::UnitZ();
        if (side) {
            normal = Vec3(position.x(), position.y(), 0.0).normalized();
            // Rounding must not add up over thousands of reflections.
            position.head<2>() = rod.radius_m * normal.head<2>();
        }
        ray = split_at_boundary(ray, normal, rod.index, 1.0).reflected;
        const double left = ray.flux();
        (side ? sum.sides : end_m == 0.0 ? sum.near : sum.far) += weight * (flux - left);
        flux = left;
    }
    sum.unfollowed += weight * flux;
}

/// Adds f(x, weight) at the nodes of Gauss and Legendre on [0, 1], drawn together at both ends by
/// x = u^2 (3 - 2u), which takes away square roots there; the weights add up to 1.
template <typename F>
void at_smoothed_nodes(int panels, F&& f) {
    constexpr std::array<double, 4> nodes{0.183434642495650, 0.525532409916329, 0.796666477413627,
                                          0.960289856497536};
    constexpr std::array<double, 4> weights{0.362683783378362, 0.313706645877887, 0.222381034453374,
                                            0.101228536290376};
    for (int panel = 0; panel < panels; ++panel) {
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            for (const double side : {-1.0, 1.0}) {
                const double u = (panel + 0.5 + 0.5 * side * nodes[i]) / panels;
                f(u * u * (3.0 - 2.0 * u), 0.5 * weights[i] / panels * 6.0 * u * (1.0 - u));
            }
        }
    }
}

}  // namespace detail

/// Shares of flux by quadrature over the disk and the directions, with every reflection followed in
/// its state of polarisation: successive planes of incidence of a skew ray differ, and total
/// reflection shifts phases.
///
/// Rays are taken with the azimuth of +x, by symmetry, from the place (h, x0) on the disk, h = b
/// sin g from the axis. Three variables: g, x0 along the chord, sin^2 of the angle to the axis;
/// split where total reflection begins, at the sides for cos(incidence) = sin th sqrt(1 - h^2/a^2).
/// @param panels  of eight nodes in g, in x0, and in each piece of the angle.
/// Error: 2e-5 of the emitted flux, from the steps where a ray meets the side once more or less;
/// 3 to 12 panels agree that well for length / radius of 8 to 10, n of 1.3 to 1.6.
inline RodFlux rod_flux(const RodGuide& rod, int panels = 4) {
    constexpr double pi = std::numbers::pi;
    const bool contact = rod.gap_m == 0.0;
    const double emitter_m = contact ? rod.radius_m : rod.source_radius_m;
    const double critical_cosine = std::sqrt(std::max(0.0, 1.0 - std::pow(rod.index, -2)));
    // Greatest sine of the angle inside to the axis.
    const double max_sine = contact ? 1.0 : 1.0 / rod.index;

    RodFlux sum;
    const auto at = [&](double angle_g, double along, double sine2, double weight) {
        const Vec3 place(emitter_m * std::cos(angle_g) * (2.0 * along - 1.0),
                         emitter_m * std::sin(angle_g), 0.0);
        const Vec3 direction(std::sqrt(sine2), 0.0, std::sqrt(1.0 - sine2));
        const PolarisedRay ray = PolarisedRay::unpolarised(direction, weight);
        if (contact) {
            const double radial = direction.x() * std::cos(angle_g);
            if (radial > critical_cosine) {
                detail::follow_in_rod(rod, place, ray, sum);
                return;
            }
            // Total reflection at the sides leaves unpolarised light unpolarised, however often.
            const double passed = std::exp(-rod.absorption_per_m * rod.length_m / direction.z());
            const double reflectance = reflection(rod.index, 1.0, direction.z()).reflectance();
            sum.far += weight * (1.0 - reflectance) * passed;
            sum.near += weight * reflectance * passed * passed;
            sum.absorbed += weight * (1.0 - passed) * (1.0 + reflectance * passed);
            return;
        }
        const Vec3 entry = place + rod.gap_m / direction.z() * direction;
        sum.onto_near += weight;
        const SplitRay split = split_at_boundary(ray, Vec3::UnitZ(), 1.0, rod.index);
        sum.near += split.reflected.flux();
        if (split.refracted) {
            detail::follow_in_rod(rod, {entry.x(), entry.y(), 0.0}, *split.refracted, sum);
        }
    };

    // g is split where even rays along a meridian of the piece beyond are held.
    std::vector<double> pieces_g{0.0};
    const double side_cosine = std::min(1.0, critical_cosine / max_sine);
    const double sine_g = rod.radius_m / emitter_m * std::sqrt(1.0 - side_cosine * side_cosine);
    if (sine_g > 0.0 && sine_g < 1.0) pieces_g.push_back(std::asin(sine_g));
    pieces_g.push_back(0.5 * pi);

    for (std::size_t piece = 0; piece + 1 < pieces_g.size(); ++piece) {
        const double from = pieces_g[piece];
        const double width = pieces_g[piece + 1] - from;
        detail::at_smoothed_nodes(panels, [&](double g_share, double g_weight) {
            const double angle_g = from + width * g_share;
            const double cosine_g = std::cos(angle_g);
            const double h_m = emitter_m * std::sin(angle_g);
            const double half_chord_m = std::sqrt(rod.radius_m * rod.radius_m - h_m * h_m);
            const double radial = half_chord_m / rod.radius_m;
            const double weight_g = g_weight * width * 4.0 / pi * cosine_g * cosine_g;
            detail::at_smoothed_nodes(panels, [&](double along, double along_weight) {
                double max_sine2 = 1.0;
                if (!contact) {
                    const double x0_m = emitter_m * cosine_g * (2.0 * along - 1.0);
                    const double reach = (half_chord_m - x0_m) / rod.gap_m;  // tan of the angle
                    max_sine2 = reach * reach / (1.0 + reach * reach);
                }
                // Squared sines outside (contact: inside) at which the far end and the sides begin
                // to reflect totally.
                const double scale = contact ? 1.0 : rod.index * rod.index;
                std::vector<double> pieces{0.0};
                for (const double sine2 :
                     {scale / (rod.index * rod.index),
                      scale * std::pow(critical_cosine / std::max(radial, 1e-9), 2)}) {
                    if (sine2 > 0.0 && sine2 < max_sine2) pieces.push_back(sine2);
                }
                std::sort(pieces.begin(), pieces.end());
                pieces.push_back(max_sine2);
                for (std::size_t i = 0; i + 1 < pieces.size(); ++i) {
                    const double step = pieces[i + 1] - pieces[i];
                    detail::at_smoothed_nodes(panels, [&](double share, double weight) {
                        at(angle_g, along, pieces[i] + step * share,
                           weight * step * weight_g * along_weight);
                    });
                }
            });
        });
    }
    return sum;
}

}  // namespace lucerna::truth
