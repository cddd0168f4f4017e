// Triangle meshes and what is known about their surface.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/vector.h"

namespace lucerna::optics {

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
    bool closed = false;                     ///< encloses a volume, consistently oriented outward
    std::shared_ptr<const struct MeshSearch> search;  ///< for kernel areas, see mesh.cpp
};

}  // namespace lucerna::optics
