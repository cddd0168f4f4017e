// Integration radii of the photon maps: adapted to each patch by pilot rays, then shrinking.
#pragma once

#include <span>
#include <vector>

#include "optics/transport/forward_trace.h"
#include "optics/transport/sensor_planes.h"
#include "optics/transport/stage.h"

namespace lucerna::optics {

/// The radius of each patch's kernels in one phase [m]; the patches of sensor planes come last.
class Radii {
public:
    Radii() = default;
    explicit Radii(std::vector<double> first_radii_m) : radii_m_(std::move(first_radii_m)) {}
    double operator[](std::uint32_t patch) const { return radii_m_[patch]; }

    /// Radii of a phase: r_i^2 = r_1^2 i^(alpha - 1) (Knaus and Zwicker, TOG 30(3), 2011, sec. 5).
    /// The variance of the mean falls with N^-alpha. Their alpha = 2/3 balances it with the square
    /// of a bias O(r^2) = O(N^(alpha - 1)). Here that bias is measured and taken off, and what is
    /// left is O(r^4): alpha = 4/5 balances that, and the error falls with N^-0.4, not N^-0.33.
    Radii at_phase(std::uint32_t number) const;

private:
    std::vector<double> radii_m_;
};

/// Photons of a trace with `rays` rays whose results are not used but for what follows.
struct PilotPhotons {
    std::vector<Photon> photons;
    std::uint32_t rays;
};

/// Expected photons in a kernel of a phase.
struct PhotonsPerKernel {
    double of_surfaces, of_sensors;
};

/// Radii at which a kernel holds about `photons` photons in a phase with `rays` rays. The rays of
/// the pilot are independent of each other.
///
/// The density is the median of what the photons of a patch see around themselves: it follows the
/// places where the light is, so that a caustic on a wide floor gets the radius of the caustic.
/// No radius exceeds an eighth of the patch's size, nor a 20th of the scene's radius.
///
/// Where kernels are `seen`, those of surfaces are narrowed until they show no more bias than 15 %.
Radii narrow_radii(const Stage& stage, const SensorPlanes& planes, const PilotPhotons& pilot,
                   const PhotonsPerKernel& photons, std::uint32_t rays, bool seen);

/// The same for seen surfaces whatever number of photons their kernels hold: as wide as the limits
/// and the bias allow.
Radii wide_radii(const Stage& stage, const SensorPlanes& planes, const PilotPhotons& pilot);

/// The same with wider kernels around points that are to be read with little bias: as wide as keeps
/// the bias at the points of a patch, root mean square, below 2 % of the light, so that about the
/// square of it is left when it is taken off. Two pilots that are independent of each other tell
/// the square of the bias by a product, whatever the noise of each is.
/// @param points  of sensor planes and surfaces.
Radii widened_around(const Stage& stage, const SensorPlanes& planes, const Radii& radii,
                     const PilotPhotons& one, const PilotPhotons& other,
                     std::span<const SurfacePoint> points);

/// Number of forward rays of a phase for which kernels of surfaces hold about `photons_per_kernel`
/// photons, in the mean over the photons of the pilot trace; 0 without photons.
std::uint32_t rays_for(const Stage& stage, const PilotPhotons& pilot, const Radii& radii,
                       double photons_per_kernel);

}  // namespace lucerna::optics
