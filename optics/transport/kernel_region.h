// The part of a kernel that other objects do not cut off.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "core/vector.h"
#include "optics/transport/stage.h"

namespace lucerna::optics {

/// Where an object stands on a plane, no photons arrive under it, and those beyond a thin wall are
/// of another room: kernels that reach across such barriers are biased by a share of the light that
/// does not fall with the radius, so that two radii do not show it. This is the kernel without what
/// lies beyond the barriers, as seen from its centre in sectors: past the plane of what stands
/// there. Any part of a kernel that is chosen without regard to the photons is a kernel.
class KernelRegion {
public:
    /// Nothing if no barrier stands within the radius, and where kernels are not cut by barriers:
    /// on curved surfaces, and across edges where a surface ends in a curve or in a corner that
    /// reaches into it.
    /// @param side  unit normal of the plane on the side of the observer.
    static std::optional<KernelRegion> within(const Stage& stage, const SurfacePoint& centre,
                                              const Vec3& side, double radius_m);

    /// Whether a point of the plane lies in the region.
    bool holds(const Vec3& position) const;
    /// Area of the region within a radius, at most that of within() [m2].
    double area_m2(double radius_m) const;

private:
    static constexpr int sectors = 16;
    struct Barrier {
        Vec2 normal = Vec2::Zero();  // away from the centre; zero if nothing stands there
        double distance_m = infinity;
    };
    KernelRegion(const Vec3& centre, const Vec3& side, double radius_m);
    Vec2 local(const Vec3& position) const;
    bool knows_patch(const Shape& shape, const SurfacePoint& centre) const;
    /// How far the patch reaches from the centre in a direction, if its outline is known [m].
    double within_outline_m(const Vec2& direction) const;

    Vec3 centre_, x_axis_, y_axis_;
    double radius_m_;
    std::array<Barrier, sectors> barriers_;
    std::vector<std::array<Vec2, 2>> outline_;  // sides of the patch, of a mesh those that are near
};

}  // namespace lucerna::optics
