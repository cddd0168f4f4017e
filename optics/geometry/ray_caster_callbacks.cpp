// What Embree asks while it follows a ray: does the ray hit this exact shape, does this triangle
// count?
#include <algorithm>

#include "optics/geometry/mesh_departure.h"
#include "optics/geometry/ray_caster_impl.h"

namespace lucerna::optics {

namespace {

/// Whether the segment between any two points of the surface runs inside or along it.
bool is_convex(const Shape& shape) {
    return !std::holds_alternative<Tube>(shape) && !std::holds_alternative<MeshInstance>(shape);
}

}  // namespace

/// Whether a triangle found in single precision counts, other than the one that the ray leaves or
/// is meant to reach: if one of these ends lies close to the triangle's plane, so that rounding may
/// have put it on the wrong side, only if double precision says so.
bool RayCaster::Impl::keeps(const Query& query, ObjectId object, std::uint32_t triangle) const {
    const MeshInstance& s = std::get<MeshInstance>(shapes[object]);
    const Mesh& mesh = *s.mesh;
    const Ray ray = to_local(s, *query.ray);
    const double near_m = 16.0 * offset_m[object];
    const Vec3& corner = mesh.vertices[mesh.triangles[triangle][0]];
    const double slope = ray.direction.dot(mesh.normals[triangle]);
    const double height_m = (corner - ray.origin).dot(mesh.normals[triangle]);
    const bool near_start = std::abs(height_m) < near_m;
    if (query.start && query.start->object == object) {
        if (near_start && !can_hit_from(mesh, query.start->primitive, triangle, ray.direction))
            return false;
    } else if (near_start && height_m / slope <= 0.0) {
        return false;
    }
    if (query.reach_m == infinity) return true;
    const bool near_end = std::abs(height_m - query.reach_m * slope) < near_m;
    if (query.end && query.end->object == object) {
        if (near_end && !can_hit_from(mesh, query.end->primitive, triangle, -ray.direction))
            return false;
    } else if (near_end && height_m / slope >= query.reach_m) {
        return false;
    }
    return true;
}

/// Whether an exact shape lies strictly between the ends of an occlusion query.
bool RayCaster::Impl::blocks(const Query& query, ObjectId object) const {
    const Shape& shape = shapes[object];
    const bool at_start = query.start && query.start->object == object;
    const bool at_end = query.end && query.end->object == object;
    if (at_start && at_end && is_convex(shape)) return false;
    if (at_end && !at_start) {  // seen from the end, whose root is left out in closed form
        const Ray back{query.ray->origin + query.reach_m * query.ray->direction,
                       -query.ray->direction};
        return optics::intersect(shape, back, query.end, query.reach_m).has_value();
    }
    const auto hit =
        optics::intersect(shape, *query.ray, at_start ? query.start : nullptr, query.reach_m);
    if (!hit) return false;
    // Along a generator of a tube the root is ill-conditioned: 1e-6 of the distance.
    return !(at_end && hit->patch == query.end->patch &&
             hit->distance_m >= query.reach_m * (1.0 - 1e-6));
}

void RayCaster::Impl::intersect_exact(const RTCIntersectFunctionNArguments* args) {
    if (!args->valid[0]) return;
    Query& query = *reinterpret_cast<Query*>(args->context);
    RTCRayHit& rayhit = *reinterpret_cast<RTCRayHit*>(args->rayhit);
    const ObjectId object = query.caster->exact[args->primID];
    const bool at_start = query.start && query.start->object == object;
    const double limit_m = std::min(static_cast<double>(rayhit.ray.tfar) + query.skipped_m,
                                    query.exact_hit.distance_m);
    const auto hit = optics::intersect(query.caster->shapes[object], *query.ray,
                                       at_start ? query.start : nullptr, limit_m);
    if (!hit) return;
    query.exact_hit = *hit;
    rayhit.ray.tfar = std::min(rayhit.ray.tfar, round_up(hit->distance_m - query.skipped_m));
    rayhit.hit.geomID = args->geomID;
    rayhit.hit.primID = args->primID;
    rayhit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
}

void RayCaster::Impl::occlude_exact(const RTCOccludedFunctionNArguments* args) {
    if (!args->valid[0]) return;
    const Query& query = *reinterpret_cast<const Query*>(args->context);
    if (query.caster->blocks(query, query.caster->exact[args->primID]))
        reinterpret_cast<RTCRay*>(args->ray)->tfar = -std::numeric_limits<float>::infinity();
}

void RayCaster::Impl::filter_triangle(const RTCFilterFunctionNArguments* args) {
    const Query& query = *reinterpret_cast<const Query*>(args->context);
    const RTCHit& hit = *reinterpret_cast<const RTCHit*>(args->hit);
    const RTCRay& ray = *reinterpret_cast<const RTCRay*>(args->ray);
    const ObjectId object = hit.instID[0] == RTC_INVALID_GEOMETRY_ID ? hit.geomID : hit.instID[0];
    const auto is_end = [&](const SurfacePoint* p) {
        return p && p->object == object && p->primitive == hit.primID;
    };
    if (is_end(query.start) || is_end(query.end)) {
        args->valid[0] = 0;
        return;
    }
    // Most triangles are so far from both ends that single precision is enough to see it.
    const Eigen::Vector3f normal(hit.Ng_x, hit.Ng_y, hit.Ng_z);
    const Eigen::Vector3f direction(ray.dir_x, ray.dir_y, ray.dir_z);
    const double slope = static_cast<double>(std::abs(direction.dot(normal)) / normal.norm());
    const double distance_m = static_cast<double>(ray.tfar) + query.skipped_m;
    const double near_m = 32.0 * query.caster->offset_m[object];
    if (slope * std::min(distance_m, query.reach_m - distance_m) > near_m) return;
    if (!query.caster->keeps(query, object, hit.primID)) args->valid[0] = 0;
}

}  // namespace lucerna::optics
