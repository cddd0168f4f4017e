// Coordinates of shapes of revolution, and rays in them.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/vector.h"

namespace lucerna::optics {

/// Frame at `from` whose z axis runs to `to`.
struct AxialFrame {
    Vec3 origin;
    double height_m;
    Frame frame;

    AxialFrame(const Vec3& from, const Vec3& to)
        : origin(from), height_m((to - from).norm()), frame((to - from) / height_m) {}

    Vec3 to_local(const Vec3& p) const { return frame.to_local(p - origin); }
    Vec3 to_world(const Vec3& p) const { return origin + frame.to_world(p); }
};

/// The part of a ray, by distance, that lies inside a convex body.
struct RayInterval {
    double enter;
    double leave;
};

/// The part of a ray inside the infinite cylinder x^2 + y^2 < radius^2, or nothing.
inline std::optional<RayInterval> inside_cylinder(const Vec3& origin, const Vec3& direction,
                                                  double radius) {
    const double a = direction.head<2>().squaredNorm();
    const double b = origin.head<2>().dot(direction.head<2>());
    const double distance = origin.head<2>().norm();
    const double c = (distance - radius) * (distance + radius);
    if (a == 0.0) {
        if (c > 0.0) return std::nullopt;
        return RayInterval{-infinity, infinity};
    }
    // The discriminant b^2 - a c without cancellation: a times the half chord's square.
    const double moment = origin.x() * direction.y() - origin.y() * direction.x();
    const double discriminant = a * radius * radius - moment * moment;
    if (discriminant <= 0.0) return std::nullopt;
    const double q = -(b + std::copysign(std::sqrt(discriminant), b));
    const double t1 = q / a;
    const double t2 = c / q;
    return RayInterval{std::min(t1, t2), std::max(t1, t2)};
}

/// Where a ray that is known to run inside the cylinder leaves it; infinite along the axis.
///
/// @param on_side  the origin lies on the cylinder: c = 0, so the far root is the sum of the roots.
inline double leaves_cylinder(const Vec3& origin, const Vec3& direction, double radius,
                              bool on_side) {
    const double a = direction.head<2>().squaredNorm();
    if (a == 0.0) return infinity;
    const double b = origin.head<2>().dot(direction.head<2>());
    if (on_side) return std::max(-2.0 * b / a, 0.0);
    const double distance = origin.head<2>().norm();
    const double c = std::min((distance - radius) * (distance + radius), 0.0);
    const double moment = origin.x() * direction.y() - origin.y() * direction.x();
    const double root = std::sqrt(std::max(a * radius * radius - moment * moment, 0.0));
    if (b <= 0.0) return (root - b) / a;
    return -c / (b + root);
}

/// The part of a ray between the planes z = 0 and z = height.
inline std::optional<RayInterval> inside_slab(double origin, double direction, double height) {
    if (direction == 0.0) {
        if (origin < 0.0 || origin > height) return std::nullopt;
        return RayInterval{-infinity, infinity};
    }
    const double t1 = -origin / direction;
    const double t2 = (height - origin) / direction;
    return RayInterval{std::min(t1, t2), std::max(t1, t2)};
}

/// Where a ray that is known to run between the planes leaves them.
inline double leaves_slab(double origin, double direction, double height) {
    if (direction == 0.0) return infinity;
    return std::max(((direction > 0.0 ? height : 0.0) - origin) / direction, 0.0);
}

}  // namespace lucerna::optics
