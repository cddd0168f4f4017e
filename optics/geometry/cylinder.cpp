#include <algorithm>

#include "core/sampling.h"
#include "optics/geometry/axial_frame.h"
#include "optics/geometry/disc_area.h"
#include "optics/geometry/round_shape.h"
#include "optics/geometry/shape_parts.h"

namespace lucerna::optics::per_shape {

namespace {

enum : Patch { side, cap_from, cap_to };

ShapeHit hit_at(const Cylinder& s, const AxialFrame& axial, const Vec3& p, double t, Patch patch) {
    if (patch == side) return side_hit(axial, p, s.radius_m, 1.0, t, patch);
    return end_hit(axial, p, 0.0, s.radius_m, patch == cap_to, t, patch);
}

}  // namespace

OptionalHit intersect(const Cylinder& s, const Ray& ray, const SurfacePoint* start, double max) {
    const AxialFrame axial(s.from, s.to);
    const Vec3 origin = axial.to_local(ray.origin);
    const Vec3 direction = axial.frame.to_local(ray.direction);
    const Patch cap_ahead = direction.z() > 0.0 ? cap_to : cap_from;
    const Patch cap_behind = direction.z() > 0.0 ? cap_from : cap_to;
    double t;
    Patch patch;
    if (start) {
        // Convex: a ray from the surface runs through the inside or not at all.
        const bool inward = start->patch == side
                                ? origin.head<2>().dot(direction.head<2>()) < 0.0
                                : start->patch == cap_behind && direction.z() != 0.0;
        if (!inward) return std::nullopt;
        const double t_side = leaves_cylinder(origin, direction, s.radius_m, start->patch == side);
        const double t_cap = leaves_slab(origin.z(), direction.z(), axial.height_m);
        t = std::min(t_side, t_cap);
        patch = t_side <= t_cap ? side : cap_ahead;
        if (!(t < max)) return std::nullopt;
    } else {
        const auto round = inside_cylinder(origin, direction, s.radius_m);
        const auto slab = inside_slab(origin.z(), direction.z(), axial.height_m);
        if (!round || !slab) return std::nullopt;
        const double enter = std::max(round->enter, slab->enter);
        const double leave = std::min(round->leave, slab->leave);
        if (enter > leave) return std::nullopt;
        if (enter > 0.0) {
            t = enter;
            patch = round->enter >= slab->enter ? side : cap_behind;
        } else {
            t = leave;
            patch = round->leave <= slab->leave ? side : cap_ahead;
        }
        if (!(t > 0.0 && t < max)) return std::nullopt;
    }
    return hit_at(s, axial, origin + t * direction, t, patch);
}

Patch patch_count(const Cylinder&) {
    return 3;
}

double patch_area_m2(const Cylinder& s, Patch patch) {
    if (patch == side) return 2.0 * pi * s.radius_m * (s.to - s.from).norm();
    return pi * s.radius_m * s.radius_m;
}

bool contains(const Cylinder& s, const Vec3& p) {
    const AxialFrame axial(s.from, s.to);
    const Vec3 q = axial.to_local(p);
    return q.head<2>().squaredNorm() <= s.radius_m * s.radius_m && q.z() >= 0.0 &&
           q.z() <= axial.height_m;
}

Eigen::AlignedBox3d bounds(const Cylinder& s) {
    const Vec3 axis = (s.to - s.from).normalized();
    return bounds(Disk{s.from, axis, s.radius_m}).merged(bounds(Disk{s.to, axis, s.radius_m}));
}

SurfacePoint sample_area(const Cylinder& s, double u1, double u2) {
    const Patch patch = choose_patch(s, u1);
    const AxialFrame axial(s.from, s.to);
    if (patch == side) return sample_side(axial, s.radius_m, 1.0, patch, u1, u2);
    return sample_end(axial, 0.0, s.radius_m, patch == cap_to, patch, u1, u2);
}

double kernel_area_m2(const Cylinder& s, const SurfacePoint& p, double radius_m) {
    const AxialFrame axial(s.from, s.to);
    if (p.patch == side) return side_kernel_area_m2(axial, s.radius_m, p.position, radius_m);
    const Vec3 centre = p.patch == cap_from ? s.from : s.to;
    return disc_disc_area((p.position - centre).norm(), radius_m, s.radius_m);
}

}  // namespace lucerna::optics::per_shape
