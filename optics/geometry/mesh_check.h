// What may be wrong with a mesh that is to bound a volume.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "optics/geometry/mesh.h"

namespace lucerna::optics {

/// Findings of check_mesh(); counts are of edges or triangles.
struct MeshReport {
    bool closed = false;            ///< each edge joins two triangles of like orientation
    bool oriented_outward = false;  ///< closed, free of cuts, normals out of the enclosed volume
    std::size_t border_edges = 0;   ///< of one triangle: the rim of a hole or sheet
    std::size_t crowded_edges = 0;  ///< of three triangles or more
    std::size_t inconsistent_edges = 0;    ///< of two triangles of which one is turned over
    std::size_t degenerate_triangles = 0;  ///< corners on a line, up to rounding
    /// Pairs of triangles that cut each other; nothing if the mesh is not a manifold surface.
    std::optional<std::size_t> self_intersections;

    /// Fit to bound a medium.
    bool solid() const { return closed && oriented_outward; }
    /// One sentence for each thing that keeps it from being fit.
    std::vector<std::string> complaints() const;
};

/// Exact in its decisions (CGAL's exact predicates); vertices at the same position count as one.
MeshReport check_mesh(const Mesh& mesh);

}  // namespace lucerna::optics
