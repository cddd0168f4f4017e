#include <algorithm>

#include "core/sampling.h"
#include "optics/geometry/shape_parts.h"

namespace lucerna::optics::per_shape {

OptionalHit intersect(const Sphere& s, const Ray& ray, const SurfacePoint* start, double max) {
    const Vec3 origin = ray.origin - s.centre;
    const double b = origin.dot(ray.direction);
    double t;
    if (start) {
        t = -2.0 * b;  // |o + t d|^2 = |o|^2 has the roots 0 and -2 o.d
    } else {
        // Discriminant from the distance of the line to the centre: no cancellation for far origins
        // (Haines et al., "Precision improvements for ray/sphere intersection", Ray Tracing Gems,
        // 2019).
        const double discriminant =
            s.radius_m * s.radius_m - (origin - b * ray.direction).squaredNorm();
        if (discriminant < 0.0) return std::nullopt;
        const double distance = origin.norm();
        const double c = (distance - s.radius_m) * (distance + s.radius_m);
        const double q = -(b + std::copysign(std::sqrt(discriminant), b));
        if (q == 0.0) return std::nullopt;
        const double t_near = std::min(q, c / q);
        const double t_far = std::max(q, c / q);
        t = t_near > 0.0 ? t_near : t_far;
    }
    if (!(t > 0.0 && t < max)) return std::nullopt;
    const Vec3 normal = (origin + t * ray.direction).normalized();
    return ShapeHit{t, s.centre + s.radius_m * normal, normal, 0, 0};
}

Patch patch_count(const Sphere&) {
    return 1;
}

double patch_area_m2(const Sphere& s, Patch) {
    return 4.0 * pi * s.radius_m * s.radius_m;
}

bool contains(const Sphere& s, const Vec3& p) {
    return (p - s.centre).squaredNorm() <= s.radius_m * s.radius_m;
}

Eigen::AlignedBox3d bounds(const Sphere& s) {
    return {s.centre - Vec3::Constant(s.radius_m), s.centre + Vec3::Constant(s.radius_m)};
}

SurfacePoint sample_area(const Sphere& s, double u1, double u2) {
    const Vec3 normal = sample_sphere(u1, u2);
    return {.position = s.centre + s.radius_m * normal, .normal = normal};
}

double kernel_area_m2(const Sphere& s, const SurfacePoint&, double radius_m) {
    // A cap cut by the chord distance r has the area pi r^2 on every sphere (Archimedes).
    const double chord_m = std::min(radius_m, 2.0 * s.radius_m);
    return pi * chord_m * chord_m;
}

}  // namespace lucerna::optics::per_shape
