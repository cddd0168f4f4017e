#include <algorithm>

#include "core/sampling.h"
#include "optics/geometry/disc_area.h"
#include "optics/geometry/shape_parts.h"

namespace lucerna::optics::per_shape {

OptionalHit intersect(const Disk& s, const Ray& ray, const SurfacePoint* start, double max) {
    if (start) return std::nullopt;
    const Vec3 to_centre = s.centre - ray.origin;
    const double t = to_centre.dot(s.normal) / ray.direction.dot(s.normal);
    if (!(t > 0.0 && t < max)) return std::nullopt;
    Vec3 p = t * ray.direction - to_centre;
    p -= p.dot(s.normal) * s.normal;
    const double distance_squared = p.squaredNorm();
    if (distance_squared > s.radius_m * s.radius_m ||
        distance_squared < s.inner_radius_m * s.inner_radius_m)
        return std::nullopt;
    return ShapeHit{t, s.centre + p, s.normal, 0, 0};
}

Patch patch_count(const Disk&) {
    return 1;
}

double patch_area_m2(const Disk& s, Patch) {
    return pi * (s.radius_m - s.inner_radius_m) * (s.radius_m + s.inner_radius_m);
}

bool contains(const Disk&, const Vec3&) {
    return false;
}

Eigen::AlignedBox3d bounds(const Disk& s) {
    const Vec3 reach = s.radius_m * (1.0 - s.normal.array().square()).max(0.0).sqrt().matrix();
    return {s.centre - reach, s.centre + reach};
}

SurfacePoint sample_area(const Disk& s, double u1, double u2) {
    // r^2 uniform in [inner^2, outer^2], along the radius of the concentric map.
    const Vec2 unit = sample_disk(u1, u2);
    const double share = std::min(unit.squaredNorm(), 1.0);
    const double inner = s.inner_radius_m;
    const double radius =
        std::sqrt(inner * inner + share * (s.radius_m - inner) * (s.radius_m + inner));
    const Vec2 p = share > 0.0 ? Vec2(unit * (radius / std::sqrt(share))) : Vec2(radius, 0.0);
    const Frame frame(s.normal);
    return {.position = s.centre + p.x() * frame.tangent + p.y() * frame.bitangent,
            .normal = s.normal};
}

double kernel_area_m2(const Disk& s, const SurfacePoint& p, double radius_m) {
    const double distance_m = (p.position - s.centre).norm();
    return disc_disc_area(distance_m, radius_m, s.radius_m) -
           disc_disc_area(distance_m, radius_m, s.inner_radius_m);
}

}  // namespace lucerna::optics::per_shape
