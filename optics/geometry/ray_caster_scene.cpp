// Shapes into Embree's scene.
#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <stdexcept>

#include "optics/geometry/ray_caster_impl.h"

namespace lucerna::optics {

namespace {

constexpr double float_epsilon = 0x1p-23;

/// The box with its surface well inside.
Eigen::AlignedBox3d grown(const Eigen::AlignedBox3d& box) {
    const Vec3 margin = Vec3::Constant(1e-9 * box.diagonal().norm());
    return {box.min() - margin, box.max() + margin};
}

}  // namespace

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

void RayCaster::Impl::bound_exact(const RTCBoundsFunctionArguments* args) {
    const Impl& caster = *static_cast<const Impl*>(args->geometryUserPtr);
    Eigen::AlignedBox3d box = bounds(caster.shapes[caster.exact[args->primID]]);
    // Grown by what rounding can move a single-precision ray within the scene.
    const Vec3 margin = Vec3::Constant(2e-6 * caster.radius_m);
    const Eigen::Vector3f low = (box.min() - margin - caster.centre).cast<float>();
    const Eigen::Vector3f high = (box.max() + margin - caster.centre).cast<float>();
    *args->bounds_o = {low.x(), low.y(), low.z(), 0.0f, high.x(), high.y(), high.z(), 0.0f};
}

}  // namespace lucerna::optics
