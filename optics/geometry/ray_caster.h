// Nearest hits of rays with objects. Only the files ray_caster*.cpp know of Embree.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "optics/geometry/shape.h"

namespace lucerna::optics {

/// All shapes of a scene, ready for ray casting; object i is shapes[i]. Safe for concurrent use.
class RayCaster {
public:
    explicit RayCaster(std::span<const Shape> shapes);
    ~RayCaster();
    RayCaster(RayCaster&&) noexcept;
    RayCaster& operator=(RayCaster&&) noexcept;

    /// Nearest hit at a distance in (0, max_distance_m), or nothing.
    ///
    /// @param start  the surface point from which the ray leaves, or nullptr for a free origin. It
    ///   is not hit again: the root at the origin is left out in closed form for exact shapes, and
    ///   the triangle is left out for meshes, so that no distance threshold is needed. On an edge
    ///   the neighbouring face may be hit at distance 0. A ray within a closed shape is never lost.
    std::optional<Hit> intersect(const Ray& ray, const SurfacePoint* start,
                                 double max_distance_m = infinity) const;

    /// True if something lies strictly between the two points. Neither end's own surface counts.
    bool occluded(const Vec3& from, const SurfacePoint* from_surface, const Vec3& to,
                  const SurfacePoint* to_surface) const;

    /// The solid objects that contain the point.
    std::vector<ObjectId> containing(const Vec3& p) const;

    /// Radius of a sphere around the bounds' centre that holds all objects [m], and that centre.
    double scene_radius_m() const;
    Vec3 scene_centre() const;

    /// The same rays through the bare library call, without refinement: for `lucerna bench`.
    /// Returns the number of hits.
    std::size_t raw_intersect(std::span<const Ray> rays) const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace lucerna::optics
