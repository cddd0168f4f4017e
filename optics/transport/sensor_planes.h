// Virtual planes through illuminance points, on which forward rays leave photons as on a surface.
#pragma once

#include <cstdint>
#include <vector>

#include "optics/geometry/ray_caster.h"
#include "optics/scene.h"

namespace lucerna::optics {

/// The points of one observer that lie in one plane.
class SensorPlanes {
public:
    /// @param margin_m  how far beyond its points a plane reaches; kernels must not be wider.
    SensorPlanes(const SceneParts& parts, const RayCaster& caster, double margin_m);

    double margin_m() const { return margin_m_; }

    std::uint32_t count() const { return static_cast<std::uint32_t>(planes_.size()); }

    /// Calls found(surface_point) for each plane that the segment crosses against its normal.
    template <typename Found>
    void crossings(const Ray& ray, double length_m, Found&& found) const {
        for (std::uint32_t i = 0; i < planes_.size(); ++i) {
            const Plane& plane = planes_[i];
            const double cosine = ray.direction.dot(plane.normal);
            if (!(cosine < 0.0)) continue;
            const double t = (plane.offset_m - ray.origin.dot(plane.normal)) / cosine;
            if (!(t > 0.0 && t < length_m)) continue;
            const Vec3 position = ray.origin + t * ray.direction;
            if (plane.bounds.squaredExteriorDistance(position) > margin_m_ * margin_m_) continue;
            found(SurfacePoint{position, plane.normal, no_object, i, i});
        }
    }

    /// An illuminance point on its plane.
    struct Point {
        Vec3 position;
        std::uint32_t plane;
        /// Distance to the nearest surface along the plane, at most the margin [m]: a kernel must
        /// not reach beyond, where no light arrives.
        double clearance_m;
        std::uint32_t index;  ///< among the points of all planes
    };
    const Point& point(std::size_t observer, std::size_t number) const {
        return points_[observer][number];
    }
    std::uint32_t point_count() const { return point_count_; }
    const Vec3& normal_of(std::uint32_t plane) const { return planes_[plane].normal; }
    /// All points of a plane.
    std::vector<Point> points_of(std::uint32_t plane) const;

private:
    struct Plane {
        Vec3 normal;
        double offset_m;
        Eigen::AlignedBox3d bounds;
    };
    double margin_m_;
    std::vector<Plane> planes_;
    std::uint32_t point_count_ = 0;
    std::vector<std::vector<Point>> points_;  // [observer][point]
};

}  // namespace lucerna::optics
