#include <algorithm>

#include "optics/geometry/mesh_search.h"
#include "optics/geometry/segment.h"
#include "optics/geometry/shape_parts.h"

namespace lucerna::optics::per_shape {

namespace {

// With more sides an outline takes longer than a search among triangles.
constexpr std::size_t most_sides = 32;

Vec3 to_local(const MeshInstance& s, const Vec3& p) {
    return s.placement.linear().transpose() * (p - s.placement.translation());
}

}  // namespace

OptionalHit intersect(const MeshInstance& s, const Ray& ray, const SurfacePoint* start,
                      double max) {
    const Ray local{to_local(s, ray.origin), s.placement.linear().transpose() * ray.direction};
    std::optional<std::uint32_t> start_triangle;
    if (start) start_triangle = start->primitive;
    const auto hit = s.mesh->search->nearest(*s.mesh, local, start_triangle, max);
    if (!hit) return std::nullopt;
    return ShapeHit{hit->distance_m,
                    s.placement * (local.origin + hit->distance_m * local.direction),
                    s.placement.linear() * s.mesh->normals[hit->triangle],
                    s.mesh->patches[hit->triangle], hit->triangle};
}

Patch patch_count(const MeshInstance& s) {
    return static_cast<Patch>(s.mesh->patch_areas_m2.size());
}

double patch_area_m2(const MeshInstance& s, Patch patch) {
    return s.mesh->patch_areas_m2[patch];
}

bool contains(const MeshInstance& s, const Vec3& p) {
    if (!s.mesh->closed) return false;
    const Vec3 q = to_local(s, p);
    // A ray through an edge counts two triangles: three directions of no special kind vote.
    int votes = 0;
    for (const Vec3& towards : {Vec3(0.8203, 0.4581, 0.3427), Vec3(-0.3719, 0.8664, -0.3332),
                                Vec3(0.2247, -0.5119, -0.8291)})
        if (s.mesh->search->winding(*s.mesh, {q, towards.normalized()}) > 0) ++votes;
    return votes >= 2;
}

Eigen::AlignedBox3d bounds(const MeshInstance& s) {
    Eigen::AlignedBox3d box;
    for (const auto& triangle : s.mesh->triangles)
        for (const std::uint32_t vertex : triangle)
            box.extend(s.placement * s.mesh->vertices[vertex]);
    return box;
}

SurfacePoint sample_area(const MeshInstance& s, double u1, double u2) {
    const Mesh& mesh = *s.mesh;
    const std::vector<double>& sums = mesh.cumulative_area_m2;
    const double target = u1 * sums.back();
    const auto above = std::upper_bound(sums.begin(), sums.end() - 1, target);
    const auto triangle = static_cast<std::uint32_t>(above - sums.begin());
    const double below = triangle == 0 ? 0.0 : sums[triangle - 1];
    const double rest = std::clamp((target - below) / mesh.areas_m2[triangle], 0.0, 1.0);
    // Uniform barycentric coordinates: Turk, "Generating random points in triangles", Graphics
    // Gems.
    const double root = std::sqrt(rest);
    const auto& [a, b, c] = mesh.triangles[triangle];
    const Vec3 p = (1.0 - root) * mesh.vertices[a] + root * (1.0 - u2) * mesh.vertices[b] +
                   root * u2 * mesh.vertices[c];
    return {.position = s.placement * p,
            .normal = s.placement.linear() * mesh.normals[triangle],
            .patch = mesh.patches[triangle],
            .primitive = triangle};
}

double kernel_area_m2(const MeshInstance& s, const SurfacePoint& p, double radius_m) {
    const Vec3 centre = to_local(s, p.position);
    const std::size_t sides = s.mesh->outlines.of(p.patch).size();
    if (sides > 0 && sides <= most_sides) {
        return plane_area_in_ball_m2(*s.mesh, p.primitive, centre, radius_m);
    }
    const double area_m2 = s.mesh->search->area_in_ball_m2(*s.mesh, p.patch, centre, radius_m);
    const double disc_m2 = pi * radius_m * radius_m;
    return std::abs(area_m2 - disc_m2) < 1e-9 * disc_m2 ? disc_m2 : area_m2;
}

std::vector<std::array<Vec3, 2>> outline_near(const MeshInstance& s, const SurfacePoint& p,
                                              double radius_m) {
    const Vec3 centre = to_local(s, p.position);
    std::vector<std::array<Vec3, 2>> near;
    for (const auto& [from, to] : s.mesh->outlines.of(p.patch)) {
        const Vec3& a = s.mesh->vertices[from];
        const Vec3& b = s.mesh->vertices[to];
        if ((nearest_on_segment(a, b, centre) - centre).squaredNorm() < square(radius_m)) {
            near.push_back({s.placement * a, s.placement * b});
        }
    }
    return near;
}

}  // namespace lucerna::optics::per_shape
