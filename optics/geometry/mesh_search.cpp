#include "optics/geometry/mesh_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "optics/geometry/disc_area.h"
#include "optics/geometry/mesh_departure.h"

namespace lucerna::optics {

namespace {

constexpr std::uint32_t leaf_size = 4;

Eigen::AlignedBox3d triangle_bounds(const Mesh& mesh, std::uint32_t triangle) {
    Eigen::AlignedBox3d box;
    for (const std::uint32_t vertex : mesh.triangles[triangle]) box.extend(mesh.vertices[vertex]);
    return box;
}

double triangle_in_ball_m2(const Mesh& mesh, std::uint32_t triangle, const Vec3& centre,
                           double radius_m) {
    const auto& [a, b, c] = mesh.triangles[triangle];
    const Vec3& normal = mesh.normals[triangle];
    const double height_m = (centre - mesh.vertices[a]).dot(normal);
    if (std::abs(height_m) >= radius_m) return 0.0;
    const Frame frame(normal);
    const auto in_plane = [&](std::uint32_t vertex) {
        return Vec2(frame.to_local(mesh.vertices[vertex] - centre).head<2>());
    };
    const std::array corners{in_plane(a), in_plane(b), in_plane(c)};
    const double disc_radius_squared = (radius_m - height_m) * (radius_m + height_m);
    if (std::all_of(corners.begin(), corners.end(), [&](const Vec2& corner) {
            return corner.squaredNorm() <= disc_radius_squared;
        }))
        return mesh.areas_m2[triangle];
    const double disc_radius_m = std::sqrt(disc_radius_squared);
    return std::max(disc_polygon_area(corners, disc_radius_m), 0.0);
}

double squared_distance_to_farthest_corner(const Eigen::AlignedBox3d& box, const Vec3& p) {
    return (p - box.min()).cwiseAbs().cwiseMax((box.max() - p).cwiseAbs()).squaredNorm();
}

}  // namespace

std::optional<double> intersect_triangle(const Mesh& mesh, std::uint32_t triangle, const Ray& ray) {
    const auto& [ia, ib, ic] = mesh.triangles[triangle];
    const Vec3 a = mesh.vertices[ia] - ray.origin;
    const Vec3 b = mesh.vertices[ib] - ray.origin;
    const Vec3 c = mesh.vertices[ic] - ray.origin;
    const double u = ray.direction.dot(b.cross(c));
    const double v = ray.direction.dot(c.cross(a));
    const double w = ray.direction.dot(a.cross(b));
    if ((u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0)) return std::nullopt;
    if (u == 0.0 && v == 0.0 && w == 0.0) return std::nullopt;
    const Vec3& normal = mesh.normals[triangle];
    return a.dot(normal) / ray.direction.dot(normal);
}

MeshSearch::MeshSearch(const Mesh& mesh, std::vector<std::uint32_t> welded)
    : order_(mesh.triangles.size()), welded_(std::move(welded)) {
    std::iota(order_.begin(), order_.end(), 0u);
    std::vector<Vec3> centroids;
    centroids.reserve(mesh.triangles.size());
    for (const auto& [a, b, c] : mesh.triangles)
        centroids.push_back((mesh.vertices[a] + mesh.vertices[b] + mesh.vertices[c]) / 3.0);
    nodes_.reserve(mesh.triangles.size());
    build(mesh, centroids, 0, static_cast<std::uint32_t>(order_.size()));
    index_vertices(mesh);
}

void MeshSearch::build(const Mesh& mesh, std::span<const Vec3> centroids, std::uint32_t first,
                       std::uint32_t count) {
    const std::size_t self = nodes_.size();
    Node node;
    node.first = first;
    node.count = count;
    node.patch = mesh.patches[order_[first]];
    Eigen::AlignedBox3d centroid_bounds;
    for (std::uint32_t i = first; i < first + count; ++i) {
        const std::uint32_t triangle = order_[i];
        node.bounds.extend(triangle_bounds(mesh, triangle));
        centroid_bounds.extend(centroids[triangle]);
        node.area_m2 += mesh.areas_m2[triangle];
        if (mesh.patches[triangle] != node.patch) node.patch = several_patches;
    }
    nodes_.push_back(node);
    if (count <= leaf_size) return;

    Eigen::Index axis;
    centroid_bounds.sizes().maxCoeff(&axis);
    const std::uint32_t half = count / 2;
    const auto begin = order_.begin() + first;
    std::nth_element(begin, begin + half, begin + count, [&](std::uint32_t i, std::uint32_t j) {
        return centroids[i][axis] != centroids[j][axis] ? centroids[i][axis] < centroids[j][axis]
                                                        : i < j;
    });
    build(mesh, centroids, first, half);
    nodes_[self].second_child = static_cast<std::uint32_t>(nodes_.size());
    build(mesh, centroids, first + half, count - half);
}

void MeshSearch::index_vertices(const Mesh& mesh) {
    first_at_vertex_.assign(mesh.vertices.size() + 1, 0);
    for (const auto& triangle : mesh.triangles)
        for (const std::uint32_t vertex : triangle) ++first_at_vertex_[welded_[vertex] + 1];
    std::partial_sum(first_at_vertex_.begin(), first_at_vertex_.end(), first_at_vertex_.begin());
    at_vertex_.resize(first_at_vertex_.back());
    std::vector<std::uint32_t> next(first_at_vertex_.begin(), first_at_vertex_.end() - 1);
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i)
        for (const std::uint32_t vertex : mesh.triangles[i])
            at_vertex_[next[welded_[vertex]]++] = i;
}

template <typename Visit>
void MeshSearch::walk(const Ray& ray, double& max_distance_m, Visit&& visit) const {
    const Vec3 inverse = ray.direction.cwiseInverse();
    std::array<std::uint32_t, 64> stack;  // the tree is balanced: depth <= 32
    std::size_t depth = 0;
    stack[depth++] = 0;
    while (depth > 0) {
        const Node& node = nodes_[stack[--depth]];
        double enter = 0.0;
        double leave = max_distance_m;
        bool meets = true;
        for (int i = 0; i < 3; ++i) {
            if (ray.direction[i] == 0.0) {
                meets = meets && ray.origin[i] >= node.bounds.min()[i] &&
                        ray.origin[i] <= node.bounds.max()[i];
                continue;
            }
            const double t1 = (node.bounds.min()[i] - ray.origin[i]) * inverse[i];
            const double t2 = (node.bounds.max()[i] - ray.origin[i]) * inverse[i];
            enter = std::max(enter, std::min(t1, t2));
            leave = std::min(leave, std::max(t1, t2));
        }
        // Flat boxes: rounding must not part enter from leave.
        if (!meets || enter > leave * (1.0 + 1e-14) + 1e-300) continue;
        if (node.second_child == 0) {
            for (std::uint32_t i = node.first; i < node.first + node.count; ++i) visit(order_[i]);
        } else {
            const auto self = static_cast<std::uint32_t>(&node - nodes_.data());
            stack[depth++] = node.second_child;
            stack[depth++] = self + 1;
        }
    }
}

std::optional<TriangleHit> MeshSearch::nearest(const Mesh& mesh, const Ray& ray,
                                               std::optional<std::uint32_t> start,
                                               double max_distance_m) const {
    std::optional<TriangleHit> best;
    walk(ray, max_distance_m, [&](std::uint32_t triangle) {
        if (start == triangle) return;
        if (start && mesh.closed && !can_hit_from(mesh, *start, triangle, ray.direction)) return;
        const auto t = intersect_triangle(mesh, triangle, ray);
        if (!t || !(*t > 0.0 && *t < max_distance_m)) return;
        max_distance_m = *t;
        best = TriangleHit{*t, triangle};
    });
    return best;
}

int MeshSearch::winding(const Mesh& mesh, const Ray& ray) const {
    int sum = 0;
    double far = infinity;
    walk(ray, far, [&](std::uint32_t triangle) {
        const auto t = intersect_triangle(mesh, triangle, ray);
        if (t && *t > 0.0) sum += ray.direction.dot(mesh.normals[triangle]) > 0.0 ? 1 : -1;
    });
    return sum;
}

double MeshSearch::area_in_ball_m2(const Mesh& mesh, std::uint32_t patch, const Vec3& centre,
                                   double radius_m) const {
    const double radius_squared = radius_m * radius_m;
    double area_m2 = 0.0;
    std::array<std::uint32_t, 64> stack;
    std::size_t depth = 0;
    stack[depth++] = 0;
    while (depth > 0) {
        const std::uint32_t self = stack[--depth];
        const Node& node = nodes_[self];
        if (node.patch != several_patches && node.patch != patch) continue;
        if (node.bounds.squaredExteriorDistance(centre) >= radius_squared) continue;
        if (node.patch == patch &&
            squared_distance_to_farthest_corner(node.bounds, centre) < radius_squared) {
            area_m2 += node.area_m2;
        } else if (node.second_child == 0) {
            for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
                if (mesh.patches[order_[i]] == patch)
                    area_m2 += triangle_in_ball_m2(mesh, order_[i], centre, radius_m);
        } else {
            stack[depth++] = node.second_child;
            stack[depth++] = self + 1;
        }
    }
    return area_m2;
}

}  // namespace lucerna::optics
