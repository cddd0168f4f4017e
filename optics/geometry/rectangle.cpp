#include <algorithm>

#include "optics/geometry/disc_area.h"
#include "optics/geometry/shape_parts.h"

namespace lucerna::optics::per_shape {

namespace {

Vec3 normal_of(const Rectangle& s) {
    return s.edge_u.cross(s.edge_v).normalized();
}

}  // namespace

OptionalHit intersect(const Rectangle& s, const Ray& ray, const SurfacePoint* start, double max) {
    if (start) return std::nullopt;
    const Vec3 scaled_normal = s.edge_u.cross(s.edge_v);
    const Vec3 to_corner = s.corner - ray.origin;
    const double t = to_corner.dot(scaled_normal) / ray.direction.dot(scaled_normal);
    if (!(t > 0.0 && t < max)) return std::nullopt;
    const Vec3 p = t * ray.direction - to_corner;
    const double u = p.dot(s.edge_u) / s.edge_u.squaredNorm();
    const double v = p.dot(s.edge_v) / s.edge_v.squaredNorm();
    if (u < 0.0 || u > 1.0 || v < 0.0 || v > 1.0) return std::nullopt;
    return ShapeHit{t, s.corner + u * s.edge_u + v * s.edge_v, scaled_normal.normalized(), 0, 0};
}

Patch patch_count(const Rectangle&) {
    return 1;
}

double patch_area_m2(const Rectangle& s, Patch) {
    return s.edge_u.cross(s.edge_v).norm();
}

bool contains(const Rectangle&, const Vec3&) {
    return false;
}

Eigen::AlignedBox3d bounds(const Rectangle& s) {
    Eigen::AlignedBox3d box(s.corner);
    box.extend(s.corner + s.edge_u);
    box.extend(s.corner + s.edge_v);
    box.extend(s.corner + s.edge_u + s.edge_v);
    return box;
}

SurfacePoint sample_area(const Rectangle& s, double u1, double u2) {
    return {.position = s.corner + u1 * s.edge_u + u2 * s.edge_v, .normal = normal_of(s)};
}

double kernel_area_m2(const Rectangle& s, const SurfacePoint& p, double radius_m) {
    const double width_m = s.edge_u.norm();
    const double height_m = s.edge_v.norm();
    const Vec3 q = p.position - s.corner;
    return disc_rectangle_area(q.dot(s.edge_u) / width_m, q.dot(s.edge_v) / height_m, width_m,
                               height_m, radius_m);
}

}  // namespace lucerna::optics::per_shape
