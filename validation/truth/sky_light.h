// Illuminance from the sky through a rectangular opening.
#pragma once

#include <algorithm>
#include <cmath>

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

/// Illuminance at x, over area elements of the opening: E = int L cos cos' / r^2 dA. The sky gives
/// `horizontal_lx` to an open plane; below the horizon lies a ground that reflects that diffusely.
/// An upright opening has its edge v along z, so that the horizon is a line of constant v.
template <typename Sky>
double sky_illuminance(const Sky& sky, double horizontal_lx, double ground_reflectance,
                       const Vec3& corner, const Vec3& u, const Vec3& v, const Vec3& x,
                       const Vec3& normal) {
    const double scale = horizontal_lx / horizontal_illuminance(sky);
    const double ground = ground_reflectance * horizontal_lx / pi;
    const Vec3 area = u.cross(v);
    const auto over = [&](double from, double to) {
        if (!(to > from)) return 0.0;
        return integral(
            [&](double t) {
                return integral(
                    [&](double s) {
                        const Vec3 way = corner + s * u + t * v - x;
                        const Vec3 w = way.normalized();
                        const double luminance = w.z() > 0.0 ? scale * sky.luminance(w) : ground;
                        return luminance * std::max(0.0, w.dot(normal)) * std::abs(w.dot(area)) /
                               way.squaredNorm();
                    },
                    0.0, 1.0, 48);
            },
            from, to, 48);
    };
    const double horizon = v.z() != 0.0 ? std::clamp((x.z() - corner.z()) / v.z(), 0.0, 1.0) : 0.0;
    return over(0.0, horizon) + over(horizon, 1.0);
}

}  // namespace lucerna::truth
