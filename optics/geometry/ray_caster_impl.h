// What is behind RayCaster: an Embree scene, and the queries that its callbacks share.
//
// Embree works in single precision. It decides which exact shapes are tried, whose hits are
// computed in double precision in its callback, and which triangle of a mesh is hit, whose hit
// point is then computed in double precision. Its coordinates are centred on the scene to lose the
// fewest digits.
#pragma once

#include <embree3/rtcore.h>

#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <type_traits>
#include <utility>

#include "optics/geometry/mesh_search.h"
#include "optics/geometry/ray_caster.h"
#include "optics/geometry/shape_parts.h"

namespace lucerna::optics {

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
    void aim(RTCRay& ray, Query& query, const Vec3& origin, double max_distance_m) const;
    const MeshInstance* mesh_of(const SurfacePoint* p) const;
    Vec3 off_surface(const MeshInstance& s, const SurfacePoint& p, const Vec3& direction) const;
    std::optional<TriangleHit> neighbour_hit(const MeshInstance& s, const SurfacePoint& p,
                                             const Ray& ray) const;
    std::optional<Hit> embree_hit(const Ray& ray, const SurfacePoint* start,
                                  double max_distance_m) const;
    void catch_slipped(const Ray& ray, const SurfacePoint* start, double max_distance_m,
                       std::optional<Hit>& hit) const;
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

/// The next float above x, rounded to float first; as std::nextafter(), which is a slow call.
inline float round_up(double x) {
    const auto rounded = static_cast<float>(x);
    if (!(rounded < std::numeric_limits<float>::infinity())) return rounded;
    if (rounded == 0.0f) return std::numeric_limits<float>::denorm_min();
    const auto bits = std::bit_cast<std::int32_t>(rounded);
    return std::bit_cast<float>(rounded > 0.0f ? bits + 1 : bits - 1);
}

inline Vec3 to_local(const MeshInstance& s, const Vec3& p) {
    return s.placement.linear().transpose() * (p - s.placement.translation());
}

inline Ray to_local(const MeshInstance& s, const Ray& ray) {
    return {to_local(s, ray.origin), s.placement.linear().transpose() * ray.direction};
}

}  // namespace lucerna::optics
