// What the photons of a pilot trace tell of the light around points.
#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "optics/transport/radii.h"

namespace lucerna::optics {

/// Where a photon arrives, and how much light it stands for: in a unit in which photons of equal
/// flux have 1.
struct Arrival {
    Vec3 position;
    double flux;
};

/// The photons of each patch, those of sensor planes last.
std::vector<std::vector<Arrival>> arrivals_by_patch(const Stage& stage, const SensorPlanes& planes,
                                                    const PilotPhotons& pilot);

/// No kernel of a patch is wider: an eighth of a surface's size, the root of its area.
double limit_of_patch_m(const Stage& stage, const SensorPlanes& planes, std::uint32_t patch);
/// The same where kernels are seen: a quarter of a plane surface.
double limit_of_seen_patch_m(const Stage& stage, const SensorPlanes& planes, std::uint32_t patch);

/// Flux within limit_m, limit_m / sqrt 2, limit_m / 2, ... of a point, the sum of its squares, and
/// its first and third moment about the point, in units of the limit.
struct LightByRadius {
    static constexpr std::size_t steps = 32;  // the last is 2e-5 of the first
    std::array<double, steps + 1> flux{}, squares{};
    std::array<Vec3, steps + 1> moment = zeros(), third_moment = zeros();

    /// A photon at the point itself is no evidence about it.
    static LightByRadius around(const Vec3& point, const std::vector<Arrival>& photons,
                                double limit_m);
    /// Around each of some points.
    static std::vector<LightByRadius> around(const std::vector<Vec3>& points,
                                             const std::vector<Arrival>& photons, double limit_m,
                                             int threads);
    /// Sum of flux times x (1 - 3/2 x^2 / r^2), as in kernels: of a step, but not of a slope.
    Vec3 moment_of_step(std::size_t i) const {
        return moment[i] - 1.5 * std::ldexp(1.0, static_cast<int>(i)) * third_moment[i];
    }

private:
    static std::array<Vec3, steps + 1> zeros() {
        std::array<Vec3, steps + 1> vectors;
        vectors.fill(Vec3::Zero());
        return vectors;
    }
};

}  // namespace lucerna::optics
