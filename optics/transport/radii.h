// Integration radii of the photon maps: adapted to each patch by pilot rays, then shrinking.
#pragma once

#include <vector>

#include "optics/transport/forward_trace.h"
#include "optics/transport/sensor_planes.h"
#include "optics/transport/stage.h"

namespace lucerna::optics {

/// The radius of each patch's kernels in one phase [m]; the patches of sensor planes come last, and
/// some of their points may have narrower kernels.
class Radii {
public:
    Radii() = default;
    /// @param of_points_m  of all points of sensor planes, or empty.
    explicit Radii(std::vector<double> first_radii_m, std::vector<double> of_points_m = {})
        : radii_m_(std::move(first_radii_m)), of_points_m_(std::move(of_points_m)) {}
    double operator[](std::uint32_t patch) const { return radii_m_[patch]; }
    /// What limits the kernel of a point of a sensor plane, infinity if nothing does.
    double of_point(std::uint32_t index) const {
        return index < of_points_m_.size() ? of_points_m_[index] : infinity;
    }

    /// Radii of a phase: r_i^2 = r_1^2 i^(alpha - 1) (Knaus and Zwicker, TOG 30(3), 2011, sec. 5).
    /// The variance of the mean falls with N^-alpha. Their alpha = 2/3 balances it with the square
    /// of a bias O(r^2) = O(N^(alpha - 1)). Here that bias is measured and taken off, and what is
    /// left is O(r^4): alpha = 4/5 balances that, and the error falls with N^-0.4, not N^-0.33.
    ///
    /// Where half of a disc is cut off, as in the corner between two walls, the bias of smooth
    /// light is O(r), and when that is taken off, O(r^2): there alpha = 2/3 balances it, if cut
    /// kernels are told apart at all.
    Radii at_phase(std::uint32_t number) const;
    void tell_cut_kernels_apart() { tells_cut_ = true; }
    /// Of the radius, that is left where half of a kernel's disc is cut off, see cut_radius_m().
    double share_of_cut() const { return share_of_cut_; }

private:
    std::vector<double> radii_m_;
    std::vector<double> of_points_m_;
    bool tells_cut_ = false;
    double share_of_cut_ = 1.0;
};

/// Photons of a trace with `rays` rays whose results are not used but for what follows.
struct PilotPhotons {
    std::vector<Photon> photons;
    std::uint32_t rays;
    Lanes luminance;  ///< weights of the wavelengths of the rays: see WavelengthSet
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
/// Where kernels are `seen`, those of surfaces are narrowed until they show no more bias than 15 %,
/// and those of plane ones may be as wide as a quarter of the patch: few photons find small things,
/// such as the dots printed on a light guide.
Radii narrow_radii(const Stage& stage, const SensorPlanes& planes, const PilotPhotons& pilot,
                   const PhotonsPerKernel& photons, std::uint32_t rays, bool seen, int threads);

/// The same for seen surfaces whatever number of photons their kernels hold: as wide as the limits
/// and the bias allow. Kernels that are cut are told apart.
Radii wide_radii(const Stage& stage, const SensorPlanes& planes, const PilotPhotons& pilot,
                 int threads);

/// Number of forward rays of a phase for which kernels of surfaces hold about `photons_per_kernel`
/// photons, in the mean over the photons of the pilot trace; 0 without photons.
std::uint32_t rays_for(const Stage& stage, const PilotPhotons& pilot, const Radii& radii,
                       double photons_per_kernel);

}  // namespace lucerna::optics
