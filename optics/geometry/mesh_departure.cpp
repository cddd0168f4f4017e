#include "optics/geometry/mesh_departure.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "optics/geometry/segment.h"

namespace lucerna::optics {

namespace {

/// The corners of a triangle, where the mesh keeps them.
class Corners {
public:
    Corners(const Mesh& mesh, std::uint32_t triangle)
        : vertices_(mesh.vertices.data()), triangle_(mesh.triangles[triangle]) {}

    const Vec3& operator[](std::size_t k) const { return vertices_[triangle_[k]]; }
    /// From corner k to the next.
    Vec3 edge(std::size_t k) const { return (*this)[(k + 1) % 3] - (*this)[k]; }

private:
    const Vec3* vertices_;
    const std::array<std::uint32_t, 3>& triangle_;
};

/// Signed distance of p from the line along an edge from a corner, times the edge's length;
/// positive inside. p lies in the plane.
double moment_about_edge(const Vec3& normal, const Vec3& corner, const Vec3& edge, const Vec3& p) {
    return normal.cross(edge).dot(p - corner);
}

/// The point of the triangle nearest to p, which lies in its plane.
Vec3 nearest_in_triangle(const Corners& corners, const Vec3& normal, const Vec3& p) {
    Vec3 nearest = p;
    double nearest_squared = infinity;
    for (std::size_t k = 0; k < 3; ++k) {
        if (moment_about_edge(normal, corners[k], corners.edge(k), p) >= 0.0) continue;
        const Vec3 q = nearest_on_segment(corners[k], corners[(k + 1) % 3], p);
        if ((q - p).squaredNorm() < nearest_squared) {
            nearest = q;
            nearest_squared = (q - p).squaredNorm();
        }
    }
    return nearest;
}

}  // namespace

bool can_hit_from(const Mesh& mesh, std::uint32_t start, std::uint32_t triangle,
                  const Vec3& direction) {
    const double away = direction.dot(mesh.normals[start]);
    if (away * direction.dot(mesh.normals[triangle]) >= 0.0) return false;
    const Vec3 outward = std::copysign(1.0, away) * mesh.normals[start];
    const Vec3& foot = mesh.vertices[mesh.triangles[start][0]];
    for (const std::uint32_t corner : mesh.triangles[triangle]) {
        const Vec3 step = mesh.vertices[corner] - foot;
        if (outward.dot(step) > 1e-9 * step.norm()) return true;
    }
    return false;
}

bool near_edge(const Mesh& mesh, std::uint32_t triangle, const Vec3& p, double distance_m) {
    const Corners corners(mesh, triangle);
    const double clearly_squared = 1.000001 * distance_m * distance_m;
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 edge = corners.edge(k);
        const double moment = moment_about_edge(mesh.normals[triangle], corners[k], edge, p);
        // Nearly all points are clearly farther away, which shows without a root and a quotient.
        const double edge_squared = edge.squaredNorm();
        if (moment > 0.0 && moment * moment > clearly_squared * edge_squared) continue;
        if (moment / std::sqrt(edge_squared) < distance_m) return true;
    }
    return false;
}

std::optional<TriangleHit> nearest_neighbour_hit(const Mesh& mesh, std::uint32_t start,
                                                 const Ray& ray) {
    std::optional<TriangleHit> best;
    mesh.search->for_each_neighbour(mesh, start, [&](std::uint32_t triangle) {
        if (!can_hit_from(mesh, start, triangle, ray.direction)) return;
        const Vec3& normal = mesh.normals[triangle];
        const Corners corners(mesh, triangle);
        // Rounding of the position, in units of the coordinates that enter it.
        const double size =
            ray.origin.cwiseAbs().maxCoeff() + (corners[1] - corners[0]).cwiseAbs().maxCoeff();
        const double rounding = 1e-14 * size;
        const auto t = intersect_triangle(mesh, triangle, ray);
        double distance_m = t.value_or(-1.0);
        if (distance_m < 0.0) {
            const double height = (ray.origin - corners[0]).dot(normal);
            const Vec3 foot = ray.origin - height * normal;
            if (std::abs(height) > rounding ||
                (nearest_in_triangle(corners, normal, foot) - foot).norm() > rounding)
                return;
            distance_m = 0.0;
        }
        if (!best || distance_m < best->distance_m) best = TriangleHit{distance_m, triangle};
    });
    return best;
}

Vec3 refine_hit(const Mesh& mesh, std::uint32_t triangle, const Ray& ray, double& distance_m) {
    const Corners corners(mesh, triangle);
    const Vec3& normal = mesh.normals[triangle];
    const double slope = ray.direction.dot(normal);
    double t = (corners[0] - ray.origin).dot(normal) / slope;
    // Nearly in the plane, the crossing of the plane says little: keep what was found.
    if (!(std::abs(slope) > 1e-9)) t = distance_m;
    Vec3 p = ray.origin + t * ray.direction;
    p -= (p - corners[0]).dot(normal) * normal;
    const Vec3 q = nearest_in_triangle(corners, normal, p);
    if (q != p) t = (q - ray.origin).dot(ray.direction);
    distance_m = std::max(t, 0.0);
    return q;
}

}  // namespace lucerna::optics
