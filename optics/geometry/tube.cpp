#include <algorithm>

#include "optics/geometry/axial_frame.h"
#include "optics/geometry/disc_area.h"
#include "optics/geometry/round_shape.h"
#include "optics/geometry/shape_parts.h"

namespace lucerna::optics::per_shape {

namespace {

enum : Patch { outer_side, inner_side, end_from, end_to };

struct Crossing {
    double t;
    Patch patch;
};

ShapeHit hit_at(const Tube& s, const AxialFrame& axial, const Vec3& p, const Crossing& at) {
    if (at.patch == outer_side) return side_hit(axial, p, s.radius_m, 1.0, at.t, at.patch);
    if (at.patch == inner_side) return side_hit(axial, p, s.inner_radius_m, -1.0, at.t, at.patch);
    return end_hit(axial, p, s.inner_radius_m, s.radius_m, at.patch == end_to, at.t, at.patch);
}

/// Next crossing of a ray that leaves the surface at `start`.
std::optional<Crossing> next_crossing(const Tube& s, double height, const Vec3& origin,
                                      const Vec3& direction, Patch start) {
    const Patch end_ahead = direction.z() > 0.0 ? end_to : end_from;
    const double t_end = leaves_slab(origin.z(), direction.z(), height);
    const double b = origin.head<2>().dot(direction.head<2>());
    if (start == inner_side && b < 0.0) {  // across the bore
        const double t = leaves_cylinder(origin, direction, s.inner_radius_m, true);
        if (t > t_end) return std::nullopt;
        return Crossing{t, inner_side};
    }
    const bool into_wall =
        start == inner_side || (start == outer_side && b < 0.0) ||
        ((start == end_from || start == end_to) && start != end_ahead && direction.z() != 0.0);
    if (!into_wall) return std::nullopt;  // away from the convex hull
    const double t_outer = leaves_cylinder(origin, direction, s.radius_m, start == outer_side);
    Crossing next = t_outer <= t_end ? Crossing{t_outer, outer_side} : Crossing{t_end, end_ahead};
    if (start != inner_side && b < 0.0) {
        const auto bore = inside_cylinder(origin, direction, s.inner_radius_m);
        // From the rim of the bore the entry may be rounded to just behind the origin.
        if (bore && bore->leave > 0.0 && bore->enter < next.t)
            next = {std::max(bore->enter, 0.0), inner_side};
    }
    return next;
}

/// First crossing at t > 0 of a ray from anywhere.
std::optional<Crossing> first_crossing(const Tube& s, double height, const Vec3& origin,
                                       const Vec3& direction) {
    const auto round = inside_cylinder(origin, direction, s.radius_m);
    const auto slab = inside_slab(origin.z(), direction.z(), height);
    if (!round || !slab) return std::nullopt;
    const Patch end_behind = direction.z() > 0.0 ? end_from : end_to;
    const Patch end_ahead = direction.z() > 0.0 ? end_to : end_from;
    const Crossing enter = round->enter >= slab->enter ? Crossing{round->enter, outer_side}
                                                       : Crossing{slab->enter, end_behind};
    const Crossing leave = round->leave <= slab->leave ? Crossing{round->leave, outer_side}
                                                       : Crossing{slab->leave, end_ahead};
    if (enter.t > leave.t) return std::nullopt;
    const auto bore = inside_cylinder(origin, direction, s.inner_radius_m);
    const bool crosses_bore = bore && bore->leave > enter.t && bore->enter < leave.t;
    const auto ahead = [](const Crossing& crossing) { return crossing.t > 0.0; };
    if (!crosses_bore) {
        if (ahead(enter)) return enter;
        if (ahead(leave)) return leave;
        return std::nullopt;
    }
    if (bore->enter > enter.t) {
        if (ahead(enter)) return enter;
        if (bore->enter > 0.0) return Crossing{bore->enter, inner_side};
    }
    if (bore->leave < leave.t) {
        if (bore->leave > 0.0) return Crossing{bore->leave, inner_side};
        if (ahead(leave)) return leave;
    }
    return std::nullopt;
}

}  // namespace

OptionalHit intersect(const Tube& s, const Ray& ray, const SurfacePoint* start, double max) {
    const AxialFrame axial(s.from, s.to);
    const Vec3 origin = axial.to_local(ray.origin);
    const Vec3 direction = axial.frame.to_local(ray.direction);
    const auto crossing = start ? next_crossing(s, axial.height_m, origin, direction, start->patch)
                                : first_crossing(s, axial.height_m, origin, direction);
    if (!crossing || crossing->t >= max) return std::nullopt;
    return hit_at(s, axial, origin + crossing->t * direction, *crossing);
}

Patch patch_count(const Tube&) {
    return 4;
}

double patch_area_m2(const Tube& s, Patch patch) {
    const double height_m = (s.to - s.from).norm();
    if (patch == outer_side) return 2.0 * pi * s.radius_m * height_m;
    if (patch == inner_side) return 2.0 * pi * s.inner_radius_m * height_m;
    return pi * (s.radius_m - s.inner_radius_m) * (s.radius_m + s.inner_radius_m);
}

bool contains(const Tube& s, const Vec3& p) {
    const AxialFrame axial(s.from, s.to);
    const Vec3 q = axial.to_local(p);
    const double distance_squared = q.head<2>().squaredNorm();
    return distance_squared <= s.radius_m * s.radius_m &&
           distance_squared >= s.inner_radius_m * s.inner_radius_m && q.z() >= 0.0 &&
           q.z() <= axial.height_m;
}

Eigen::AlignedBox3d bounds(const Tube& s) {
    return bounds(Cylinder{s.from, s.to, s.radius_m});
}

SurfacePoint sample_area(const Tube& s, double u1, double u2) {
    const Patch patch = choose_patch(s, u1);
    const AxialFrame axial(s.from, s.to);
    if (patch == outer_side) return sample_side(axial, s.radius_m, 1.0, patch, u1, u2);
    if (patch == inner_side) return sample_side(axial, s.inner_radius_m, -1.0, patch, u1, u2);
    return sample_end(axial, s.inner_radius_m, s.radius_m, patch == end_to, patch, u1, u2);
}

double kernel_area_m2(const Tube& s, const SurfacePoint& p, double radius_m) {
    const AxialFrame axial(s.from, s.to);
    if (p.patch == outer_side) return side_kernel_area_m2(axial, s.radius_m, p.position, radius_m);
    if (p.patch == inner_side)
        return side_kernel_area_m2(axial, s.inner_radius_m, p.position, radius_m);
    const double distance_m = (p.position - (p.patch == end_from ? s.from : s.to)).norm();
    return disc_disc_area(distance_m, radius_m, s.radius_m) -
           disc_disc_area(distance_m, radius_m, s.inner_radius_m);
}

}  // namespace lucerna::optics::per_shape
