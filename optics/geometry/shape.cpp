#include "optics/geometry/shape.h"

#include "optics/geometry/axial_frame.h"
#include "optics/geometry/shape_parts.h"

namespace lucerna::optics {

namespace {

/// The side of a round shape on which `patch` lies, as the radius of that cylinder.
std::optional<double> round_side_radius_m(const Shape& shape, std::uint32_t patch) {
    if (const auto* cylinder = std::get_if<Cylinder>(&shape))
        if (patch == 0) return cylinder->radius_m;
    if (const auto* tube = std::get_if<Tube>(&shape)) {
        if (patch == 0) return tube->radius_m;
        if (patch == 1) return tube->inner_radius_m;
    }
    return std::nullopt;
}

AxialFrame axial_frame(const Shape& shape) {
    if (const auto* tube = std::get_if<Tube>(&shape)) return AxialFrame(tube->from, tube->to);
    const Cylinder& cylinder = std::get<Cylinder>(shape);
    return AxialFrame(cylinder.from, cylinder.to);
}

}  // namespace

std::optional<ShapeHit> intersect(const Shape& shape, const Ray& ray, const SurfacePoint* start,
                                  double max_distance_m) {
    return std::visit(
        [&](const auto& s) { return per_shape::intersect(s, ray, start, max_distance_m); }, shape);
}

std::uint32_t patch_count(const Shape& shape) {
    return std::visit([](const auto& s) { return per_shape::patch_count(s); }, shape);
}

double patch_area_m2(const Shape& shape, std::uint32_t patch) {
    return std::visit([&](const auto& s) { return per_shape::patch_area_m2(s, patch); }, shape);
}

double area_m2(const Shape& shape) {
    double area = 0.0;
    for (std::uint32_t patch = 0; patch < patch_count(shape); ++patch)
        area += patch_area_m2(shape, patch);
    return area;
}

bool is_solid(const Shape& shape) {
    if (const auto* instance = std::get_if<MeshInstance>(&shape)) return instance->mesh->closed;
    return !std::holds_alternative<Rectangle>(shape) && !std::holds_alternative<Disk>(shape);
}

bool contains(const Shape& shape, const Vec3& p) {
    return std::visit([&](const auto& s) { return per_shape::contains(s, p); }, shape);
}

Eigen::AlignedBox3d bounds(const Shape& shape) {
    return std::visit([](const auto& s) { return per_shape::bounds(s); }, shape);
}

SurfacePoint sample_area(const Shape& shape, double u1, double u2) {
    return std::visit([&](const auto& s) { return per_shape::sample_area(s, u1, u2); }, shape);
}

double kernel_area_m2(const Shape& shape, const SurfacePoint& p, double radius_m) {
    return std::visit([&](const auto& s) { return per_shape::kernel_area_m2(s, p, radius_m); },
                      shape);
}

bool is_plane(const Shape& shape, std::uint32_t patch) {
    if (std::holds_alternative<Cylinder>(shape)) return patch >= 1;
    if (std::holds_alternative<Tube>(shape)) return patch >= 2;
    if (const auto* s = std::get_if<MeshInstance>(&shape)) return s->mesh->outlines.is_plane(patch);
    return !std::holds_alternative<Sphere>(shape);
}

double off_plane_m(const Shape& shape, double radius_m) {
    const auto* s = std::get_if<MeshInstance>(&shape);
    return s ? 2.0 * s->mesh->outlines.tolerance_m() + MeshOutlines::tilt_rad * radius_m : 0.0;
}

std::vector<std::array<Vec3, 2>> outline_near(const Shape& shape, const SurfacePoint& p,
                                              double radius_m) {
    const auto ring = [](const std::array<Vec3, 4>& corners) {
        std::vector<std::array<Vec3, 2>> sides;
        for (std::size_t i = 0; i < 4; ++i) sides.push_back({corners[i], corners[(i + 1) % 4]});
        return sides;
    };
    if (const auto* s = std::get_if<Rectangle>(&shape)) {
        return ring({s->corner, s->corner + s->edge_u, s->corner + s->edge_u + s->edge_v,
                     s->corner + s->edge_v});
    }
    if (const auto* s = std::get_if<Box>(&shape)) {
        const auto axis = static_cast<int>(p.patch / 2);
        const Vec3 u = s->size_m[(axis + 1) % 3] * Vec3::Unit((axis + 1) % 3);
        const Vec3 v = s->size_m[(axis + 2) % 3] * Vec3::Unit((axis + 2) % 3);
        const Vec3 corner = (p.patch % 2 == 1 ? s->size_m[axis] : 0.0) * Vec3::Unit(axis);
        return ring({s->placement * corner, s->placement * (corner + u),
                     s->placement * (corner + u + v), s->placement * (corner + v)});
    }
    if (const auto* s = std::get_if<MeshInstance>(&shape)) {
        return per_shape::outline_near(*s, p, radius_m);
    }
    return {};
}

bool unrolls(const Shape& shape, std::uint32_t patch) {
    return round_side_radius_m(shape, patch).has_value();
}

bool within_kernel(const Shape& object_shape, const SurfacePoint& p, const SurfacePoint& q,
                   double radius_m) {
    if (p.object != q.object || p.patch != q.patch) return false;
    const Vec3 step = q.position - p.position;
    if (step.squaredNorm() >= radius_m * radius_m) return false;  // no path is shorter
    const std::optional<double> side_radius_m = round_side_radius_m(object_shape, p.patch);
    if (!side_radius_m) return true;
    const AxialFrame frame = axial_frame(object_shape);
    const Vec3 a = frame.to_local(p.position);
    const Vec3 b = frame.to_local(q.position);
    const double angle = std::atan2(a.x() * b.y() - a.y() * b.x(), a.x() * b.x() + a.y() * b.y());
    return std::hypot(*side_radius_m * angle, b.z() - a.z()) < radius_m;
}

}  // namespace lucerna::optics
