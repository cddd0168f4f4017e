// The forward photon map (docs/method.md eq. 2): photons from the lights, gathered where a backward
// ray meets a scattering surface.
#pragma once

#include <array>
#include <memory>
#include <numbers>
#include <vector>

#include "optics/transport/cell_grid.h"
#include "optics/transport/forward_trace.h"
#include "optics/transport/kernel_lattice.h"
#include "optics/transport/kernel_region.h"
#include "optics/transport/radii.h"

namespace lucerna::optics {

/// Number of the patch whose kernels may hold the point; points of sensor planes follow the
/// patches.
inline std::uint32_t kernel_patch(const Stage& stage, const SurfacePoint& p) {
    return p.object == no_object ? stage.patch_count() + p.patch : stage.patch_index(p);
}

/// True if q lies in the kernel of p; both have the same kernel patch.
bool in_kernel(const Stage& stage, const SurfacePoint& p, const SurfacePoint& q, double radius_m);

/// Calls use(hash) for the cells of the grid of its kernel patch that the kernel of p meets.
/// @param radius_m  at most that of cells.
template <typename Use>
void for_each_cell_of_kernel(const Stage& stage, const SurfacePoint& p, double cell_m,
                             double radius_m, const Use& use) {
    const bool on_sensor = p.object == no_object;
    const bool plane = on_sensor || stage.patch_is_plane(stage.patch_index(p));
    const double off_plane_m =
        on_sensor ? 0.0 : optics::off_plane_m(stage.parts().objects[p.object].shape, radius_m);
    PatchCells(kernel_patch(stage, p), cell_m)
        .for_each_around(p.position, radius_m, plane ? &p.normal : nullptr,
                         off_plane_m + stage.nudge_m(), use);
}

/// Areas over which the kernel of p collects, and its narrow one: that within the inner radius, or
/// in a flat disc the integral of its weights, which is the whole area [m2].
struct KernelAreas {
    double full, inner;
    bool flat_disc = false;  ///< whole, and without way along the surface that is not straight
};
KernelAreas kernel_areas(const Stage& stage, const SurfacePoint& p, double radius_m);

/// Local direction toward where a photon came from, for the BSDF at the centre of the kernel. The
/// cosine is that at the photon's own point, so that a curved surface loses no grazing light.
/// @param normal     at the photon's point.
/// @param direction  of its flight.
Vec3 kernel_direction(const Frame& frame, const Vec3& normal, const Vec3& direction);

/// Kernels are summed twice from the same photons: evenly, and as a narrower kernel. In a whole
/// disc the bias is c r^2, so that bias(r) = 2 (L(r) - L(r / sqrt 2)) up to O(r^4)
/// (docs/method.md eq. 8). Where half of the disc or more is cut off, the centre of what is left is
/// off the point, and the bias is c r.
inline constexpr double inner_radius_factor = 0.70710678118654752;

/// Weight in the narrow kernel of a flat, whole disc at the distance sqrt(s) r: the polynomial of
/// least degree that ends at 0, holds a constant and knows no s, so that bias(r) = L(r) - L_narrow
/// up to O(r^4) (kernels of order 4: Gasser, Mueller and Mammitzsch, J. R. Stat. Soc. B 47 (1985),
/// 238-252). What is left has 0.6 times the O(r^4) of two radii, and less noise: nothing jumps
/// where a photon crosses a rim.
template <typename Real>
constexpr Real narrow_weight(Real s) {
    return Real{6} * (Real{1} - Real{2} * s) * (Real{1} - s);
}

/// Least variance of L(r) - L_narrow over that of L, of photons of equal flux: the mean of
/// (1 - narrow_weight(s))^2 over the disc.
inline constexpr double variance_of_bias = 3.8;

/// A step of light of height h that runs through the middle of a whole disc changes neither kernel,
/// though the point is off by h / 2. But it is lopsided: the mean over the disc of
/// f (d / r) (1 - 3/2 d^2 / r^2) is h / (15 pi), and that of a steady slope is 0. Times this factor
/// it bounds what is left of the bias beside a straight step at up to 0.4 r: 1 to 0.45 of it are
/// left there. Further away it points toward the dark side, and at most 0.24 of it are left.
inline constexpr double bias_per_moment_of_step = 7.5 * pi;

/// Bias over the difference of both kernels. Else than in a flat disc, where it is 1, it lies
/// between those of the two radii above by the share that the inner disc lacks.
double bias_per_difference(const KernelAreas& areas, double radius_m);

/// Radius of a kernel of which a rim or a barrier leaves `areas`: from `share` of its own one where
/// half of the disc is left, or less, to all of it where nothing is cut off. See Radii.
double cut_radius_m(const KernelAreas& areas, double radius_m, double share);

/// On plane patches, the light in kernels is interpolated between points of a square lattice at
/// this distance from each other, in radii, where much is seen around them. The lattice lies
/// elsewhere in each phase: what interpolation adds to the bias is known in the mean, and is
/// counted with it.
inline constexpr double spacing_per_radius = 0.5;
/// How far from a point the kernels around it reach then, in radii.
inline constexpr double reach_of_lattice = 1.0 + std::numbers::sqrt2 * spacing_per_radius;

/// Where and how photons are gathered.
struct GatherPoint {
    const SurfacePoint& point;
    const Frame& frame;
    const Vec3& wo;  ///< local direction toward the observer
    const Bsdf& bsdf;
    const SurfaceOptics& optics;
    double most_radius_m = infinity;       ///< of the kernel
    std::uint32_t sensor_point = ~0u;      ///< index of a point of a sensor plane, if it is one
    const KernelRegion* region = nullptr;  ///< that barriers leave of the kernel, if there are any
    const std::vector<bool>* but_of = nullptr;  ///< lights whose photons are left out, if any
    bool tells_steps = false;                   ///< which costs time
    /// Area of the surface that this gather stands for, if that is known and no barrier is near
    /// [m2].
    double seen_m2 = infinity;
    /// Which photons of indirect light count, by the side of the surface on which they arrive.
    bool from_above = true, from_below = true;
};

using PerAxis = std::array<Lanes, 3>;
inline const PerAxis zero_per_axis{Lanes::Zero(), Lanes::Zero(), Lanes::Zero()};

struct Gathered {
    Lanes radiance = Lanes::Zero();  ///< at the full radius [W/(m2 sr nm)]
    Lanes bias = Lanes::Zero();      ///< of it, as both kernels tell
    std::uint32_t photons = 0;       ///< in the kernel
    float summed = 0.0f;  ///< photons added up for it: a share of them where gathers are shared
    /// Share of the area of the kernel's disc; told of diffuse plane patches.
    float left = 1.0f;
    /// Where asked, in flat discs: first moment over r, which points to where it is brighter; and
    /// that of a step, see bias_per_moment_of_step.
    PerAxis slope = zero_per_axis, step = zero_per_axis;

    void operator+=(const Gathered& other) {
        radiance += other.radiance;
        bias += other.bias;
        photons += other.photons;
        summed += other.summed;
        for (std::size_t i = 0; i < 3; ++i) {
            slope[i] += other.slope[i];
            step[i] += other.step[i];
        }
    }
};

/// Scattered flux in a kernel: all of it, and that of the narrow one, which holds what lies within
/// the inner radius or, in a flat disc, all by its weight.
struct KernelSums {
    Lanes full = Lanes::Zero(), narrow = Lanes::Zero();

    /// L = 1 / (A N) sum f dPhi                                              docs/method.md eq. 2
    Gathered over(const KernelAreas& areas, double radius_m, double rays) const;
};

/// Immutable after construction. Consistent: biased by O(r^2), and by nothing else.
class ForwardMap {
public:
    ForwardMap() = default;
    /// @param photons  lists of them; their order counts, how they are split does not.
    /// @param rays     number of forward rays whose photons these are.
    ForwardMap(const Stage& stage, const Radii& radii, std::span<const std::vector<Photon>> photons,
               std::uint64_t rays, int threads);

    /// Scattered radiance at a point from the photons around it.
    Gathered gather(const Phase& phase, const Radii& radii, const GatherPoint& at) const;

    std::size_t size() const { return fluxes_.size(); }
    bool empty() const { return fluxes_.empty(); }
    std::size_t bytes() const {
        return size() * (sizeof(Lanes) + sizeof(Arrival)) + grid_.bytes() +
               (lattice_points_ ? lattice_points_->bytes() : 0);
    }

private:
    // A photon as it stands in its bucket of the hashed grid: 16 bytes, for the cache, as most
    // photons of a cell are out of reach. Cells that share a bucket are told apart by distance and
    // patch.
    struct Candidate {
        Eigen::Vector3f position;
        std::uint32_t key;

        static constexpr std::uint32_t common_bit = 2;
        /// @param above   whether it arrives on the side of the normal.
        /// @param common  whether its path has the common hero.
        static std::uint32_t key_of(std::uint32_t patch, bool above, bool common) {
            return 4 * patch + (common ? common_bit : 0) + (above ? 1 : 0);
        }
        std::uint32_t patch() const { return key / 4; }
        bool on_common_lane() const { return (key & common_bit) != 0; }
        bool above() const { return key % 2 == 1; }
    };
    // What is looked at of a photon only where the surface is not plain or not diffuse.
    struct Arrival {
        SurfacePoint point;
        Vec3 direction;
        std::uint32_t light;
    };
    struct Buckets {
        std::array<std::size_t, 64> numbers;
        std::size_t count = 0;
    };
    Buckets buckets_around(const Stage& stage, const GatherPoint& at, double cell_m,
                           double radius_m) const;
    template <typename Use>
    void for_each_in_kernel(const Stage& stage, const GatherPoint& at, double cell_m,
                            double radius_m, bool flat_disc, const Use& use) const;
    std::uint32_t add_by_place(const GatherPoint& at, const Buckets& buckets, std::uint32_t key,
                               double radius_m, bool flat_disc, KernelSums& sums) const;
    Arriving arriving(const Stage& stage, const GatherPoint& at, bool above, double cell_m,
                      double radius_m, const KernelAreas& areas) const;
    std::optional<Arriving> arriving_between(const Stage& stage, const GatherPoint& at, bool above,
                                             double radius_m, double share_of_cut) const;
    Gathered gather_by_place(const Stage& stage, const GatherPoint& at, double cell_m,
                             double radius_m, double share_of_cut, const Lanes& from_above,
                             const Lanes& from_below) const;
    void lay_lattices(const Stage& stage, const Radii& radii,
                      std::span<const std::vector<Photon>> photons);

    BucketTable<Candidate> grid_;  // cell size: the patch's radius
    std::size_t bucket_mask_ = 0;
    RawArray<Lanes> fluxes_;      // in the order of the grid
    RawArray<Arrival> arrivals_;  // the same
    double rays_ = 1.0;
    std::vector<std::uint32_t> lattice_of_patch_;  // its number, for patches that have one
    struct Lattice {
        SurfacePoint origin;
        Frame frame;
    };
    std::vector<Lattice> lattices_;
    std::unique_ptr<KernelLattice> lattice_points_;
};

}  // namespace lucerna::optics
