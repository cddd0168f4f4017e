// Which triangles of a mesh meet at an edge.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <tuple>
#include <vector>

#include "optics/geometry/mesh.h"

namespace lucerna::optics {

/// For each vertex the first one at the same position.
std::vector<std::uint32_t> weld_vertices(const std::vector<Vec3>& vertices);

/// One side of a triangle, from the lower to the higher vertex.
struct TriangleSide {
    std::uint32_t low, high, triangle;
    bool reversed;  ///< the triangle runs through it from high to low
};

/// What a number of sides at one edge is.
enum class EdgeKind {
    regular,       ///< two triangles of like orientation
    inconsistent,  ///< two triangles of which one is turned over
    border,        ///< one triangle
    crowded        ///< three or more
};

inline EdgeKind edge_kind(std::span<const TriangleSide> sides) {
    if (sides.size() == 1) return EdgeKind::border;
    if (sides.size() > 2) return EdgeKind::crowded;
    return sides[0].reversed != sides[1].reversed ? EdgeKind::regular : EdgeKind::inconsistent;
}

/// Calls visit(sides) for each edge with the sides of triangles that lie on it.
template <typename Visit>
void for_each_edge(const Mesh& mesh, const std::vector<std::uint32_t>& welded, Visit&& visit) {
    std::vector<TriangleSide> sides;
    sides.reserve(3 * mesh.triangles.size());
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t from = welded[mesh.triangles[i][k]];
            const std::uint32_t to = welded[mesh.triangles[i][(k + 1) % 3]];
            sides.push_back({std::min(from, to), std::max(from, to), i, from > to});
        }
    const auto edge = [](const TriangleSide& side) { return std::tie(side.low, side.high); };
    std::sort(sides.begin(), sides.end(), [&](const TriangleSide& a, const TriangleSide& b) {
        return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
    });
    for (std::size_t first = 0, last; first < sides.size(); first = last) {
        last = first + 1;
        while (last < sides.size() && edge(sides[last]) == edge(sides[first])) ++last;
        visit(std::span<const TriangleSide>(sides).subspan(first, last - first));
    }
}

}  // namespace lucerna::optics
