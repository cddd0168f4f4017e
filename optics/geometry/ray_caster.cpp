#include "optics/geometry/ray_caster.h"

#include <algorithm>

#include "optics/geometry/axial_frame.h"
#include "optics/geometry/mesh_departure.h"
#include "optics/geometry/ray_caster_impl.h"

namespace lucerna::optics {

namespace {

/// Where a ray that starts in the box leaves it.
double leaves(const Eigen::AlignedBox3d& box, const Ray& ray) {
    double distance_m = infinity;
    for (int i = 0; i < 3; ++i)
        distance_m = std::min(distance_m, leaves_slab(ray.origin[i] - box.min()[i],
                                                      ray.direction[i], box.sizes()[i]));
    return distance_m;
}

}  // namespace

RayCaster::Impl::Query RayCaster::Impl::new_query(const Ray& ray, const SurfacePoint* start) const {
    Query query;
    rtcInitIntersectContext(&query.context);
    query.context.filter = filter;
    query.caster = this;
    query.ray = &ray;
    query.start = start;
    query.end = nullptr;
    query.reach_m = infinity;
    query.skipped_m = 0.0;
    query.exact_hit.distance_m = infinity;
    return query;
}

void RayCaster::Impl::aim(RTCRay& ray, Query& query, const Vec3& origin,
                          double max_distance_m) const {
    const Vec3& direction = query.ray->direction;
    Vec3 from = origin - centre;
    // From far away, start just before the scene: a distant origin would cost all digits.
    const double to_centre_m = -from.dot(direction);
    if (to_centre_m > 3.0 * radius_m) {
        query.skipped_m = to_centre_m - 2.0 * radius_m;
        from += query.skipped_m * direction;
    }
    ray.org_x = static_cast<float>(from.x());
    ray.org_y = static_cast<float>(from.y());
    ray.org_z = static_cast<float>(from.z());
    ray.tnear = 0.0f;
    ray.dir_x = static_cast<float>(direction.x());
    ray.dir_y = static_cast<float>(direction.y());
    ray.dir_z = static_cast<float>(direction.z());
    ray.time = 0.0f;
    ray.tfar = round_up(max_distance_m - query.skipped_m);
    ray.mask = ~0u;
    ray.id = 0;
    ray.flags = 0;
}

const MeshInstance* RayCaster::Impl::mesh_of(const SurfacePoint* p) const {
    if (!p || p->object == no_object) return nullptr;
    return std::get_if<MeshInstance>(&shapes[p->object]);
}

/// The point moved off its triangle to the side of the direction, beyond the reach of rounding.
Vec3 RayCaster::Impl::off_surface(const MeshInstance& s, const SurfacePoint& p,
                                  const Vec3& direction) const {
    const Vec3 normal = s.placement.linear() * s.mesh->normals[p.primitive];
    return p.position + std::copysign(offset_m[p.object], direction.dot(normal)) * normal;
}

/// Hit of a triangle that touches the ray's own, if the ray starts close to an edge.
std::optional<TriangleHit> RayCaster::Impl::neighbour_hit(const MeshInstance& s,
                                                          const SurfacePoint& p,
                                                          const Ray& ray) const {
    // Wide enough that off_surface() stays in a corner of more than 1 degree if it is not near.
    const double near_m = 64.0 * offset_m[p.object];
    if (!near_edge(*s.mesh, p.primitive, to_local(s, ray.origin), near_m)) return std::nullopt;
    return nearest_neighbour_hit(*s.mesh, p.primitive, to_local(s, ray));
}

Hit RayCaster::Impl::mesh_hit(ObjectId object, std::uint32_t triangle, const Ray& ray,
                              double distance_m) const {
    const MeshInstance& s = std::get<MeshInstance>(shapes[object]);
    Hit hit;
    hit.distance_m = distance_m;
    hit.point.position =
        s.placement * refine_hit(*s.mesh, triangle, to_local(s, ray), hit.distance_m);
    hit.point.normal = s.placement.linear() * s.mesh->normals[triangle];
    hit.point.object = object;
    hit.point.patch = s.mesh->patches[triangle];
    hit.point.primitive = triangle;
    return hit;
}

std::optional<Hit> RayCaster::Impl::embree_hit(const Ray& ray, const SurfacePoint* start,
                                               double max_distance_m) const {
    Query query = new_query(ray, start);
    Vec3 origin = ray.origin;
    std::optional<Hit> nearest;
    if (const MeshInstance* s = mesh_of(start)) {
        origin = off_surface(*s, *start, ray.direction);
        if (const auto next = neighbour_hit(*s, *start, ray);
            next && next->distance_m < max_distance_m) {
            nearest = mesh_hit(start->object, next->triangle, ray, next->distance_m);
            max_distance_m = next->distance_m;
        }
    }
    RTCRayHit rayhit;
    aim(rayhit.ray, query, origin, max_distance_m);
    rayhit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rayhit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    query.exact_hit.distance_m = max_distance_m;
    rtcIntersect1(scene.get(), &query.context, &rayhit);

    const RTCHit& found = rayhit.hit;
    if (found.geomID == RTC_INVALID_GEOMETRY_ID) return nearest;
    const bool instanced = found.instID[0] != RTC_INVALID_GEOMETRY_ID;
    if (!instanced && found.geomID == exact_geometry) {
        const ShapeHit& hit = query.exact_hit;
        nearest = Hit{{.position = hit.position,
                       .normal = hit.normal,
                       .object = exact[found.primID],
                       .patch = hit.patch,
                       .primitive = hit.primitive},
                      hit.distance_m};
        return nearest;
    }
    const Hit hit = mesh_hit(instanced ? found.instID[0] : found.geomID, found.primID, ray,
                             static_cast<double>(rayhit.ray.tfar) + query.skipped_m);
    if (hit.distance_m < max_distance_m) nearest = hit;
    return nearest;
}

const Eigen::AlignedBox3d& RayCaster::Impl::bounds_of(ObjectId closed_mesh) const {
    return std::lower_bound(closed_meshes.begin(), closed_meshes.end(), closed_mesh,
                            [](const auto& entry, ObjectId id) { return entry.first < id; })
        ->second;
}

/// Single precision misses a triangle now and then where many meet in a corner. A ray that should
/// have left a closed mesh by the time it leaves its bounds is tried again in double precision.
void RayCaster::Impl::catch_slipped(const Ray& ray, const SurfacePoint* start,
                                    double max_distance_m, std::optional<Hit>& hit) const {
    const auto try_again = [&](ObjectId object) {
        const SurfacePoint* own_start = start && start->object == object ? start : nullptr;
        const auto missed = optics::intersect(shapes[object], ray, own_start, max_distance_m);
        if (!missed) return;
        max_distance_m = missed->distance_m;
        hit = mesh_hit(object, missed->primitive, ray, missed->distance_m);
    };
    if (hit) {  // then only the mesh into which the ray started is known to be left
        const MeshInstance* s = mesh_of(start);
        if (!s || !s->mesh->closed || hit->point.object == start->object) return;
        const Vec3 normal = s->placement.linear() * s->mesh->normals[start->primitive];
        if (!(ray.direction.dot(normal) < 0.0)) return;
        const double leave_m = leaves(bounds_of(start->object), ray);
        if (leave_m <= max_distance_m && hit->distance_m > leave_m) try_again(start->object);
    } else {
        for (const auto& [object, box] : closed_meshes)
            if (box.contains(ray.origin) && leaves(box, ray) <= max_distance_m) try_again(object);
    }
}

RayCaster::RayCaster(std::span<const Shape> shapes) : impl_(std::make_unique<Impl>(shapes)) {}
RayCaster::~RayCaster() = default;
RayCaster::RayCaster(RayCaster&&) noexcept = default;
RayCaster& RayCaster::operator=(RayCaster&&) noexcept = default;

std::optional<Hit> RayCaster::intersect(const Ray& ray, const SurfacePoint* start,
                                        double max_distance_m) const {
    std::optional<Hit> hit = impl_->embree_hit(ray, start, max_distance_m);
    if (!impl_->closed_meshes.empty() && !(hit && !start)) {
        impl_->catch_slipped(ray, start, max_distance_m, hit);
    }
    return hit;
}

bool RayCaster::occluded(const Vec3& from, const SurfacePoint* from_surface, const Vec3& to,
                         const SurfacePoint* to_surface) const {
    const Vec3 step = to - from;
    const double distance_m = step.norm();
    if (distance_m == 0.0) return false;
    const Ray ray{from, step / distance_m};
    Impl::Query query = impl_->new_query(ray, from_surface);
    query.end = to_surface;
    query.reach_m = distance_m;
    Vec3 origin = from;
    Vec3 end = to;
    const auto neighbour_blocks = [&](const MeshInstance& s, const SurfacePoint& p, const Ray& out,
                                      const SurfacePoint* other) {
        const auto next = impl_->neighbour_hit(s, p, out);
        return next && next->distance_m < distance_m * (1.0 - 1e-9) &&
               !(other && other->object == p.object && other->primitive == next->triangle);
    };
    if (const MeshInstance* s = impl_->mesh_of(from_surface)) {
        if (neighbour_blocks(*s, *from_surface, ray, to_surface)) return true;
        origin = impl_->off_surface(*s, *from_surface, ray.direction);
    }
    if (const MeshInstance* s = impl_->mesh_of(to_surface)) {
        if (neighbour_blocks(*s, *to_surface, {to, -ray.direction}, from_surface)) return true;
        end = impl_->off_surface(*s, *to_surface, -ray.direction);
    }
    RTCRay embree_ray;
    impl_->aim(embree_ray, query, origin, distance_m);
    if (end != to || origin != from) {
        const Vec3 direction = (end - origin).normalized();
        embree_ray.dir_x = static_cast<float>(direction.x());
        embree_ray.dir_y = static_cast<float>(direction.y());
        embree_ray.dir_z = static_cast<float>(direction.z());
    }
    rtcOccluded1(impl_->scene.get(), &query.context, &embree_ray);
    return embree_ray.tfar < 0.0f;
}

std::vector<ObjectId> RayCaster::containing(const Vec3& p) const {
    std::vector<ObjectId> objects;
    for (const auto& [object, box] : impl_->solids)
        if (box.contains(p) && contains(impl_->shapes[object], p)) objects.push_back(object);
    return objects;
}

double RayCaster::scene_radius_m() const {
    return impl_->radius_m;
}
Vec3 RayCaster::scene_centre() const {
    return impl_->centre;
}

std::size_t RayCaster::raw_intersect(std::span<const Ray> rays) const {
    std::size_t hits = 0;
    for (const Ray& ray : rays) {
        Impl::Query query = impl_->new_query(ray, nullptr);
        query.context.filter = nullptr;
        RTCRayHit rayhit;
        impl_->aim(rayhit.ray, query, ray.origin, infinity);
        rayhit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        rtcIntersect1(impl_->scene.get(), &query.context, &rayhit);
        if (rayhit.hit.geomID != RTC_INVALID_GEOMETRY_ID) ++hits;
    }
    return hits;
}

}  // namespace lucerna::optics
