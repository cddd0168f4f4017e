#include "optics/geometry/ray_caster.h"

#include <embree3/rtcore.h>
#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <type_traits>

#include "optics/geometry/axial_frame.h"
#include "optics/geometry/mesh_departure.h"
#include "optics/geometry/shape_parts.h"

// Embree works in single precision. It decides which exact shapes are tried, whose hits are
// computed in double precision in its callback, and which triangle of a mesh is hit, whose hit
// point is then computed in double precision. Its coordinates are centred on the scene to lose the
// fewest digits.

namespace lucerna::optics {

namespace {

constexpr double float_epsilon = 0x1p-23;

template <auto release>
struct Release {
    template <typename T>
    void operator()(T* p) const {
        release(p);
    }
};
template <typename Handle, auto release>
using Owned = std::unique_ptr<std::remove_pointer_t<Handle>, Release<release>>;
using Device = Owned<RTCDevice, rtcReleaseDevice>;
using Scene = Owned<RTCScene, rtcReleaseScene>;
using Geometry = Owned<RTCGeometry, rtcReleaseGeometry>;

float round_up(double x) {
    return std::nextafter(static_cast<float>(x), std::numeric_limits<float>::infinity());
}

Ray to_local(const MeshInstance& s, const Ray& ray) {
    return {s.placement.linear().transpose() * (ray.origin - s.placement.translation()),
            s.placement.linear().transpose() * ray.direction};
}

/// The box with its surface well inside.
Eigen::AlignedBox3d grown(const Eigen::AlignedBox3d& box) {
    const Vec3 margin = Vec3::Constant(1e-9 * box.diagonal().norm());
    return {box.min() - margin, box.max() + margin};
}

/// Where a ray that starts in the box leaves it.
double leaves(const Eigen::AlignedBox3d& box, const Ray& ray) {
    double distance_m = infinity;
    for (int i = 0; i < 3; ++i)
        distance_m = std::min(distance_m, leaves_slab(ray.origin[i] - box.min()[i],
                                                      ray.direction[i], box.sizes()[i]));
    return distance_m;
}

/// Whether the segment between any two points of the surface runs inside or along it.
bool is_convex(const Shape& shape) {
    return !std::holds_alternative<Tube>(shape) && !std::holds_alternative<MeshInstance>(shape);
}

}  // namespace

struct RayCaster::Impl {
    /// What the callbacks need to know of one ray; Embree hands them the pointer to its first
    /// member.
    struct Query {
        RTCIntersectContext context;
        const Impl* caster;
        const Ray* ray;
        const SurfacePoint* start;
        const SurfacePoint* end;  ///< of an occlusion query
        double reach_m;           ///< distance of the end, or infinite
        double skipped_m;         ///< the single-precision ray starts so much later
        ShapeHit exact_hit;       ///< nearest so far; valid once Embree reports the exact geometry
    };

    explicit Impl(std::span<const Shape> all);

    void add_exact_shapes();
    void add_meshes();
    Geometry new_triangles(const Mesh& mesh, const Placement& to_embree) const;
    Scene new_scene() const;
    void commit(RTCScene s) const;
    void throw_on_error() const;

    Query new_query(const Ray& ray, const SurfacePoint* start) const;
    RTCRay embree_ray(Query& query, const Vec3& origin, double max_distance_m) const;
    const MeshInstance* mesh_of(const SurfacePoint* p) const;
    Vec3 off_surface(const MeshInstance& s, const SurfacePoint& p, const Vec3& direction) const;
    std::optional<TriangleHit> neighbour_hit(const MeshInstance& s, const SurfacePoint& p,
                                             const Ray& ray) const;
    std::optional<Hit> embree_hit(const Ray& ray, const SurfacePoint* start,
                                  double max_distance_m) const;
    std::optional<Hit> slipped_through(const Ray& ray, const SurfacePoint* start,
                                       const std::optional<Hit>& found,
                                       double max_distance_m) const;
    Hit mesh_hit(ObjectId object, std::uint32_t triangle, const Ray& ray, double distance_m) const;
    const Eigen::AlignedBox3d& bounds_of(ObjectId closed_mesh) const;
    bool keeps(const Query& query, ObjectId object, std::uint32_t triangle) const;
    bool blocks(const Query& query, ObjectId object) const;

    static void intersect_exact(const RTCIntersectFunctionNArguments* args);
    static void occlude_exact(const RTCOccludedFunctionNArguments* args);
    static void bound_exact(const RTCBoundsFunctionArguments* args);
    static void filter_triangle(const RTCFilterFunctionNArguments* args);

    std::vector<Shape> shapes;
    std::vector<ObjectId> exact;   ///< the objects of exact shape, by Embree's primitive number
    std::vector<double> offset_m;  ///< per mesh object: safely above single-precision rounding
    std::vector<std::pair<ObjectId, Eigen::AlignedBox3d>> solids;
    std::vector<std::pair<ObjectId, Eigen::AlignedBox3d>> closed_meshes;  ///< of the solids
    Vec3 centre = Vec3::Zero();
    double radius_m = 0.0;
    RTCFilterFunctionN filter = nullptr;
    Device device;
    Scene scene;
    std::map<const Mesh*, Scene> mesh_scenes;
    unsigned exact_geometry;
};

RayCaster::Impl::Impl(std::span<const Shape> all)
    : shapes(all.begin(), all.end()),
      offset_m(shapes.size(), 0.0),
      device(rtcNewDevice(nullptr)),
      exact_geometry(static_cast<unsigned>(shapes.size())) {
    if (!device) throw std::runtime_error("Embree cannot be started on this machine");
    Eigen::AlignedBox3d box;
    for (ObjectId object = 0; object < shapes.size(); ++object) {
        const Eigen::AlignedBox3d object_bounds = bounds(shapes[object]);
        box.extend(object_bounds);
        if (is_solid(shapes[object])) solids.emplace_back(object, object_bounds);
        if (!std::holds_alternative<MeshInstance>(shapes[object]))
            exact.push_back(object);
        else if (is_solid(shapes[object]))
            closed_meshes.emplace_back(object, grown(object_bounds));
    }
    if (!box.isEmpty()) {
        centre = box.center();
        radius_m = 0.5 * box.diagonal().norm();
    }
    scene = new_scene();
    add_exact_shapes();
    add_meshes();
    commit(scene.get());
}

Scene RayCaster::Impl::new_scene() const {
    Scene s(rtcNewScene(device.get()));
    rtcSetSceneBuildQuality(s.get(), RTC_BUILD_QUALITY_HIGH);
    rtcSetSceneFlags(s.get(), static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST |
                                                         RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION));
    return s;
}

void RayCaster::Impl::throw_on_error() const {
    const RTCError error = rtcGetDeviceError(device.get());
    if (error == RTC_ERROR_OUT_OF_MEMORY)
        throw std::runtime_error("not enough memory for the ray caster of the scene");
    if (error != RTC_ERROR_NONE)
        throw std::runtime_error(fmt::format("Embree reports error {}", static_cast<int>(error)));
}

void RayCaster::Impl::commit(RTCScene s) const {
    // On one thread: which of two triangles is hit on their common edge depends on the tree, and a
    // tree that threads build together depends on their number.
    tbb::task_arena(1).execute([&] { rtcJoinCommitScene(s); });
    throw_on_error();
}

void RayCaster::Impl::add_exact_shapes() {
    if (exact.empty()) return;
    Geometry geometry(rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_USER));
    rtcSetGeometryUserPrimitiveCount(geometry.get(), static_cast<unsigned>(exact.size()));
    rtcSetGeometryUserData(geometry.get(), this);
    rtcSetGeometryBoundsFunction(geometry.get(), bound_exact, nullptr);
    rtcSetGeometryIntersectFunction(geometry.get(), intersect_exact);
    rtcSetGeometryOccludedFunction(geometry.get(), occlude_exact);
    rtcCommitGeometry(geometry.get());
    rtcAttachGeometryByID(scene.get(), geometry.get(), exact_geometry);
    throw_on_error();
}

void RayCaster::Impl::add_meshes() {
    std::map<const Mesh*, int> uses;
    for (const Shape& shape : shapes)
        if (const auto* s = std::get_if<MeshInstance>(&shape)) ++uses[s->mesh.get()];
    if (uses.empty()) return;
    filter = filter_triangle;
    const Placement to_centre(Eigen::Translation3d(-centre));
    for (ObjectId object = 0; object < shapes.size(); ++object) {
        const auto* s = std::get_if<MeshInstance>(&shapes[object]);
        if (!s) continue;
        const Placement to_embree = to_centre * s->placement;
        const Eigen::AlignedBox3d box = bounds(*s);
        double coordinate_m =
            (box.min() - centre).cwiseAbs().cwiseMax((box.max() - centre).cwiseAbs()).maxCoeff();
        Geometry geometry;
        if (uses[s->mesh.get()] == 1) {
            geometry = new_triangles(*s->mesh, to_embree);
        } else {
            Scene& mesh_scene = mesh_scenes[s->mesh.get()];
            if (!mesh_scene) {
                mesh_scene = new_scene();
                const Geometry triangles = new_triangles(*s->mesh, Placement::Identity());
                rtcAttachGeometryByID(mesh_scene.get(), triangles.get(), 0);
                commit(mesh_scene.get());
            }
            for (const Vec3& vertex : s->mesh->vertices)
                coordinate_m = std::max(coordinate_m, vertex.cwiseAbs().maxCoeff());
            coordinate_m *= 2.0;  // the ray is rounded once more on its way into the mesh
            geometry.reset(rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_INSTANCE));
            rtcSetGeometryInstancedScene(geometry.get(), mesh_scene.get());
            const Eigen::Matrix4f matrix = to_embree.matrix().cast<float>();
            rtcSetGeometryTransform(geometry.get(), 0, RTC_FORMAT_FLOAT4X4_COLUMN_MAJOR,
                                    matrix.data());
            rtcCommitGeometry(geometry.get());
        }
        offset_m[object] = 4.0 * float_epsilon * coordinate_m;
        rtcAttachGeometryByID(scene.get(), geometry.get(), object);
        throw_on_error();
    }
}

Geometry RayCaster::Impl::new_triangles(const Mesh& mesh, const Placement& to_embree) const {
    Geometry geometry(rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE));
    auto* vertices = static_cast<float*>(
        rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                3 * sizeof(float), mesh.vertices.size()));
    auto* indices = static_cast<std::uint32_t*>(
        rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                3 * sizeof(std::uint32_t), mesh.triangles.size()));
    throw_on_error();
    for (const Vec3& vertex : mesh.vertices) {
        const Vec3 p = to_embree * vertex;
        for (int i = 0; i < 3; ++i) *vertices++ = static_cast<float>(p[i]);
    }
    for (const auto& triangle : mesh.triangles)
        indices = std::copy(triangle.begin(), triangle.end(), indices);
    rtcCommitGeometry(geometry.get());
    throw_on_error();
    return geometry;
}

// ---- one ray ----

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

RTCRay RayCaster::Impl::embree_ray(Query& query, const Vec3& origin, double max_distance_m) const {
    const Vec3& direction = query.ray->direction;
    Vec3 from = origin - centre;
    // From far away, start just before the scene: a distant origin would cost all digits.
    const double to_centre_m = -from.dot(direction);
    if (to_centre_m > 3.0 * radius_m) {
        query.skipped_m = to_centre_m - 2.0 * radius_m;
        from += query.skipped_m * direction;
    }
    RTCRay ray;
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
    return ray;
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
    const Ray local = to_local(s, ray);
    // Wide enough that off_surface() stays in a corner of more than 1 degree if it is not near.
    const double near_m = 64.0 * offset_m[p.object];
    if (!near_edge(*s.mesh, p.primitive, local.origin, near_m)) return std::nullopt;
    return nearest_neighbour_hit(*s.mesh, p.primitive, local);
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
    rayhit.ray = embree_ray(query, origin, max_distance_m);
    rayhit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rayhit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    query.exact_hit.distance_m = max_distance_m;
    rtcIntersect1(scene.get(), &query.context, &rayhit);

    const RTCHit& found = rayhit.hit;
    if (found.geomID == RTC_INVALID_GEOMETRY_ID) return nearest;
    const bool instanced = found.instID[0] != RTC_INVALID_GEOMETRY_ID;
    if (!instanced && found.geomID == exact_geometry) {
        const ShapeHit& hit = query.exact_hit;
        return Hit{{.position = hit.position,
                    .normal = hit.normal,
                    .object = exact[found.primID],
                    .patch = hit.patch,
                    .primitive = hit.primitive},
                   hit.distance_m};
    }
    const Hit hit = mesh_hit(instanced ? found.instID[0] : found.geomID, found.primID, ray,
                             static_cast<double>(rayhit.ray.tfar) + query.skipped_m);
    if (hit.distance_m < max_distance_m) return hit;
    return nearest;
}

const Eigen::AlignedBox3d& RayCaster::Impl::bounds_of(ObjectId closed_mesh) const {
    return std::lower_bound(closed_meshes.begin(), closed_meshes.end(), closed_mesh,
                            [](const auto& entry, ObjectId id) { return entry.first < id; })
        ->second;
}

/// Single precision misses a triangle now and then where many meet in a corner. A ray that should
/// have left a closed mesh by the time it leaves its bounds is tried again in double precision.
std::optional<Hit> RayCaster::Impl::slipped_through(const Ray& ray, const SurfacePoint* start,
                                                    const std::optional<Hit>& found,
                                                    double max_distance_m) const {
    std::optional<Hit> nearest;
    const auto try_again = [&](ObjectId object, const Eigen::AlignedBox3d& box) {
        const double leave_m = leaves(box, ray);
        if (leave_m > max_distance_m || (found && found->distance_m <= leave_m)) return;
        const SurfacePoint* own_start = start && start->object == object ? start : nullptr;
        const auto hit = optics::intersect(shapes[object], ray, own_start, max_distance_m);
        if (!hit) return;
        max_distance_m = hit->distance_m;
        nearest = mesh_hit(object, hit->primitive, ray, hit->distance_m);
    };
    if (found) {  // then only the mesh into which the ray started is known to be left
        const MeshInstance* s = mesh_of(start);
        if (!s || !s->mesh->closed || found->point.object == start->object) return nearest;
        const Vec3 normal = s->placement.linear() * s->mesh->normals[start->primitive];
        if (ray.direction.dot(normal) < 0.0) try_again(start->object, bounds_of(start->object));
    } else {
        for (const auto& [object, box] : closed_meshes)
            if (box.contains(ray.origin)) try_again(object, box);
    }
    return nearest;
}

// ---- Embree's callbacks ----

void RayCaster::Impl::bound_exact(const RTCBoundsFunctionArguments* args) {
    const Impl& caster = *static_cast<const Impl*>(args->geometryUserPtr);
    Eigen::AlignedBox3d box = bounds(caster.shapes[caster.exact[args->primID]]);
    // Grown by what rounding can move a single-precision ray within the scene.
    const Vec3 margin = Vec3::Constant(2e-6 * caster.radius_m);
    const Eigen::Vector3f low = (box.min() - margin - caster.centre).cast<float>();
    const Eigen::Vector3f high = (box.max() + margin - caster.centre).cast<float>();
    *args->bounds_o = {low.x(), low.y(), low.z(), 0.0f, high.x(), high.y(), high.z(), 0.0f};
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

// ---- public ----

RayCaster::RayCaster(std::span<const Shape> shapes) : impl_(std::make_unique<Impl>(shapes)) {}
RayCaster::~RayCaster() = default;
RayCaster::RayCaster(RayCaster&&) noexcept = default;
RayCaster& RayCaster::operator=(RayCaster&&) noexcept = default;

std::optional<Hit> RayCaster::intersect(const Ray& ray, const SurfacePoint* start,
                                        double max_distance_m) const {
    const std::optional<Hit> hit = impl_->embree_hit(ray, start, max_distance_m);
    if (impl_->closed_meshes.empty() || (hit && !start)) return hit;
    const std::optional<Hit> missed = impl_->slipped_through(ray, start, hit, max_distance_m);
    return missed ? missed : hit;
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
    RTCRay embree_ray = impl_->embree_ray(query, origin, distance_m);
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
        rayhit.ray = impl_->embree_ray(query, ray.origin, infinity);
        rayhit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        rtcIntersect1(impl_->scene.get(), &query.context, &rayhit);
        if (rayhit.hit.geomID != RTC_INVALID_GEOMETRY_ID) ++hits;
    }
    return hits;
}

}  // namespace lucerna::optics
