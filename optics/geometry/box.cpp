#include <algorithm>

#include "optics/geometry/axial_frame.h"
#include "optics/geometry/disc_area.h"
#include "optics/geometry/shape_parts.h"

namespace lucerna::optics::per_shape {

namespace {

int axis_of(Patch patch) {
    return static_cast<int>(patch / 2);
}
bool is_upper(Patch patch) {
    return patch % 2 == 1;
}
Patch patch_of(int axis, bool upper) {
    return static_cast<Patch>(2 * axis + (upper ? 1 : 0));
}

Vec3 to_local(const Box& s, const Vec3& p) {
    return s.placement.linear().transpose() * (p - s.placement.translation());
}

Vec3 normal_of(const Box& s, Patch patch) {
    const Vec3 axis = s.placement.linear().col(axis_of(patch));
    return is_upper(patch) ? axis : Vec3(-axis);
}

ShapeHit hit_at(const Box& s, const Vec3& origin, const Vec3& direction, double t, Patch patch) {
    Vec3 p = (origin + t * direction).cwiseMax(0.0).cwiseMin(s.size_m);
    p[axis_of(patch)] = is_upper(patch) ? s.size_m[axis_of(patch)] : 0.0;
    return {t, s.placement * p, normal_of(s, patch), patch, patch};
}

}  // namespace

OptionalHit intersect(const Box& s, const Ray& ray, const SurfacePoint* start, double max) {
    const Vec3 origin = to_local(s, ray.origin);
    const Vec3 direction = s.placement.linear().transpose() * ray.direction;
    if (start) {
        // Convex: a ray from the surface runs through the inside or not at all.
        const double outward = direction[axis_of(start->patch)];
        if (is_upper(start->patch) ? outward >= 0.0 : outward <= 0.0) return std::nullopt;
        double t = infinity;
        int axis = 0;
        for (int i = 0; i < 3; ++i) {
            const double leave = leaves_slab(origin[i], direction[i], s.size_m[i]);
            if (leave < t) t = leave, axis = i;
        }
        if (t >= max) return std::nullopt;
        return hit_at(s, origin, direction, t, patch_of(axis, direction[axis] > 0.0));
    }
    RayInterval inside{-infinity, infinity};
    int enter_axis = 0;
    int leave_axis = 0;
    for (int i = 0; i < 3; ++i) {
        const auto slab = inside_slab(origin[i], direction[i], s.size_m[i]);
        if (!slab) return std::nullopt;
        if (slab->enter > inside.enter) inside.enter = slab->enter, enter_axis = i;
        if (slab->leave < inside.leave) inside.leave = slab->leave, leave_axis = i;
    }
    if (inside.enter > inside.leave) return std::nullopt;
    const bool enters = inside.enter > 0.0;
    const double t = enters ? inside.enter : inside.leave;
    if (!(t > 0.0 && t < max)) return std::nullopt;
    const int axis = enters ? enter_axis : leave_axis;
    return hit_at(s, origin, direction, t, patch_of(axis, (direction[axis] > 0.0) != enters));
}

Patch patch_count(const Box&) {
    return 6;
}

double patch_area_m2(const Box& s, Patch patch) {
    const int axis = axis_of(patch);
    return s.size_m[(axis + 1) % 3] * s.size_m[(axis + 2) % 3];
}

bool contains(const Box& s, const Vec3& p) {
    const Vec3 q = to_local(s, p);
    return (q.array() >= 0.0).all() && (q.array() <= s.size_m.array()).all();
}

Eigen::AlignedBox3d bounds(const Box& s) {
    const Vec3 half = 0.5 * s.size_m;
    const Vec3 centre = s.placement * half;
    const Vec3 reach = s.placement.linear().cwiseAbs() * half;
    return {centre - reach, centre + reach};
}

SurfacePoint sample_area(const Box& s, double u1, double u2) {
    const Patch patch = choose_patch(s, u1);
    const int axis = axis_of(patch);
    Vec3 p;
    p[axis] = is_upper(patch) ? s.size_m[axis] : 0.0;
    p[(axis + 1) % 3] = u1 * s.size_m[(axis + 1) % 3];
    p[(axis + 2) % 3] = u2 * s.size_m[(axis + 2) % 3];
    return {.position = s.placement * p,
            .normal = normal_of(s, patch),
            .patch = patch,
            .primitive = patch};
}

double kernel_area_m2(const Box& s, const SurfacePoint& p, double radius_m) {
    const Vec3 q = to_local(s, p.position);
    const int u = (axis_of(p.patch) + 1) % 3;
    const int v = (axis_of(p.patch) + 2) % 3;
    return disc_rectangle_area(q[u], q[v], s.size_m[u], s.size_m[v], radius_m);
}

}  // namespace lucerna::optics::per_shape
