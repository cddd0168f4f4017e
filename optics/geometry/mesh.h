// Triangle meshes and what is known about their surface.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/vector.h"
#include "optics/geometry/mesh_outlines.h"

namespace lucerna::optics {

class MeshSearch;  // see mesh_search.h

/// An indexed triangle mesh in its own coordinates [m], with what was derived from it once.
struct Mesh {
    std::vector<Vec3> vertices;
    std::vector<std::array<std::uint32_t, 3>> triangles;

    // Derived by prepare_mesh():
    std::vector<Vec3> normals;               ///< unit, one per triangle
    std::vector<double> areas_m2;            ///< one per triangle
    std::vector<double> cumulative_area_m2;  ///< running sum of areas
    std::vector<std::uint32_t> patches;      ///< smooth region of each triangle
    std::vector<double> patch_areas_m2;      ///< one per patch
    MeshOutlines outlines;                   ///< of the plane patches
    bool closed = false;                     ///< encloses a volume, consistently oriented outward
    std::shared_ptr<const MeshSearch> search;
};

/// Neighbouring triangles whose normals differ by less belong to one patch: the surface counts as
/// smooth across their edge. A flat polygon is one patch, and so is a sphere of 18 or more segments
/// around; the faces of a box or of an octagonal prism are patches of their own.
inline constexpr double crease_angle_rad = 20.0 * pi / 180.0;

/// A triangle needs more area than this [m2], so that its normal has all digits.
inline constexpr double smallest_triangle_m2 = 1e-150;

/// Derives normals, areas, patches and the search structure of an indexed mesh.
///
/// Vertices at exactly the same position count as one where neighbours are sought; the indices are
/// kept as they are. Throws std::invalid_argument if there is no triangle, an index is out of
/// range, a coordinate is not finite, or a triangle has no area.
std::shared_ptr<const Mesh> prepare_mesh(std::vector<Vec3> vertices,
                                         std::vector<std::array<std::uint32_t, 3>> triangles);

}  // namespace lucerna::optics
