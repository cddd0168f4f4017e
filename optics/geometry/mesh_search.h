// Search among the triangles of one mesh, in double precision and in the mesh's own coordinates.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "optics/geometry/mesh.h"

namespace lucerna::optics {

struct TriangleHit {
    double distance_m;
    std::uint32_t triangle;
};

/// A tree of bounding boxes over the triangles, and which triangles meet at each vertex.
class MeshSearch {
public:
    /// @param welded  for each vertex the first vertex at the same position
    MeshSearch(const Mesh& mesh, std::vector<std::uint32_t> welded);

    /// Nearest triangle along the ray at a distance in (0, max_distance_m).
    ///
    /// @param start  triangle that the ray leaves: it is not hit, nor on a closed mesh any that the
    ///   ray cannot pass from its side (see can_hit_from)
    std::optional<TriangleHit> nearest(const Mesh& mesh, const Ray& ray,
                                       std::optional<std::uint32_t> start,
                                       double max_distance_m) const;

    /// Number of triangles that the half line leaves through their back, less those that it enters
    /// through their front: 1 inside a closed mesh, 0 outside.
    int winding(const Mesh& mesh, const Ray& ray) const;

    /// Area of the part of a patch that lies in the open ball: exact, and fast since parts of the
    /// tree that lie wholly in the ball count by their sum.
    double area_in_ball_m2(const Mesh& mesh, std::uint32_t patch, const Vec3& centre,
                           double radius_m) const;

    /// The triangles that share a vertex with this one, and itself.
    template <typename Visit>
    void for_each_neighbour(const Mesh& mesh, std::uint32_t triangle, Visit&& visit) const {
        for (const std::uint32_t vertex : mesh.triangles[triangle])
            for (std::uint32_t i = first_at_vertex_[welded_[vertex]];
                 i < first_at_vertex_[welded_[vertex] + 1]; ++i)
                visit(at_vertex_[i]);
    }

private:
    static constexpr std::uint32_t several_patches = ~0u;

    struct Node {
        Eigen::AlignedBox3d bounds;
        double area_m2 = 0.0;
        std::uint32_t patch = several_patches;
        std::uint32_t first = 0;  ///< of its triangles in order_
        std::uint32_t count = 0;
        std::uint32_t second_child = 0;  ///< 0 for a leaf; the first child follows its parent
    };

    void build(const Mesh& mesh, std::span<const Vec3> centroids, std::uint32_t first,
               std::uint32_t count);
    void index_vertices(const Mesh& mesh);
    /// Calls visit(triangle) for those whose boxes the half line up to max_distance_m meets;
    /// `visit` may shorten max_distance_m.
    template <typename Visit>
    void walk(const Ray& ray, double& max_distance_m, Visit&& visit) const;

    std::vector<Node> nodes_;
    std::vector<std::uint32_t> order_;
    std::vector<std::uint32_t> welded_;
    std::vector<std::uint32_t> first_at_vertex_;
    std::vector<std::uint32_t> at_vertex_;
};

/// Distance at which the ray meets the triangle, or nothing. Edges belong to both neighbours: the
/// sign of each edge's moment is computed from the same numbers for both, so no ray slips between.
std::optional<double> intersect_triangle(const Mesh& mesh, std::uint32_t triangle, const Ray& ray);

}  // namespace lucerna::optics
