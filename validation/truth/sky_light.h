// Illuminance from the sky through a rectangular opening.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/vector.h"
#include "validation/truth/quadrature.h"

namespace lucerna::truth {

/// A sky of ISO 15469, z up: gradation (a, b) and indicatrix (c, d, e) as the standard lists them.
struct StandardSky {
    double a, b, c, d, e;
    Vec3 sun;  ///< unit

    /// In any unit, of a direction with the sine of elevation w.z() > 0.
    double luminance(const Vec3& w) const {
        const double chi = std::acos(std::clamp(w.dot(sun), -1.0, 1.0));
        return (1.0 + a * std::exp(b / w.z())) *
               (1.0 + c * (std::exp(d * chi) - std::exp(d * pi / 2.0)) +
                e * std::cos(chi) * std::cos(chi));
    }
};

/// The overcast sky in its own formula.
struct OvercastSky {
    double luminance(const Vec3& w) const { return (1.0 + 2.0 * w.z()) / 3.0; }
};

/// Illuminance of an open horizontal plane, in the sky's unit: over zenith angle and azimuth.
template <typename Sky>
double horizontal_illuminance(const Sky& sky) {
    return integral(
        [&](double zenith) {
            return std::cos(zenith) * std::sin(zenith) *
                   integral(
                       [&](double azimuth) {
                           return sky.luminance({std::sin(zenith) * std::cos(azimuth),
                                                 std::sin(zenith) * std::sin(azimuth),
                                                 std::cos(zenith)});
                       },
                       0.0, 2.0 * pi, 64);
        },
        0.0, pi / 2.0, 32);
}

/// Illuminance at x of what is seen through a parallelogram: E = int L cos cos' / r^2 dA over its
/// area elements, L by the direction from x.
/// @param splits  fractions of v where L has kinks along u.
/// @param panels  of eight nodes each, along each edge and between splits.
template <typename Luminance>
double illuminance_through(const Luminance& luminance, const Vec3& corner, const Vec3& u,
                           const Vec3& v, std::vector<double> splits, const Vec3& x,
                           const Vec3& normal, int panels = 48) {
    const Vec3 area = u.cross(v);
    const auto over = [&](double from, double to) {
        if (!(to > from)) return 0.0;
        return integral(
            [&](double t) {
                return integral(
                    [&](double s) {
                        const Vec3 way = corner + s * u + t * v - x;
                        const Vec3 w = way.normalized();
                        const double cosine = w.dot(normal);
                        if (!(cosine > 0.0)) return 0.0;
                        return luminance(w) * cosine * std::abs(w.dot(area)) / way.squaredNorm();
                    },
                    0.0, 1.0, panels);
            },
            from, to, panels);
    };
    splits.push_back(0.0);
    splits.push_back(1.0);
    for (double& split : splits) split = std::clamp(split, 0.0, 1.0);
    std::sort(splits.begin(), splits.end());
    double sum = 0.0;
    for (std::size_t i = 1; i < splits.size(); ++i) sum += over(splits[i - 1], splits[i]);
    return sum;
}

/// Illuminance at x through an opening with the sky beyond. The sky gives `horizontal_lx` to an
/// open plane; below the horizon lies a ground that reflects that diffusely. An upright opening has
/// its edge v along z, so that the horizon is a line of constant v.
/// @param transmittance  of what fills the opening, by the direction from x.
template <typename Sky, typename Transmittance>
double sky_illuminance(const Sky& sky, double horizontal_lx, double ground_reflectance,
                       const Vec3& corner, const Vec3& u, const Vec3& v, const Vec3& x,
                       const Vec3& normal, const Transmittance& transmittance) {
    const double scale = horizontal_lx / horizontal_illuminance(sky);
    const double ground = ground_reflectance * horizontal_lx / pi;
    const double horizon = v.z() != 0.0 ? (x.z() - corner.z()) / v.z() : 0.0;
    return illuminance_through(
        [&](const Vec3& w) {
            return transmittance(w) * (w.z() > 0.0 ? scale * sky.luminance(w) : ground);
        },
        corner, u, v, {horizon}, x, normal);
}

/// The same through an opening with nothing in it.
template <typename Sky>
double sky_illuminance(const Sky& sky, double horizontal_lx, double ground_reflectance,
                       const Vec3& corner, const Vec3& u, const Vec3& v, const Vec3& x,
                       const Vec3& normal) {
    return sky_illuminance(sky, horizontal_lx, ground_reflectance, corner, u, v, x, normal,
                           [](const Vec3&) { return 1.0; });
}

}  // namespace lucerna::truth
