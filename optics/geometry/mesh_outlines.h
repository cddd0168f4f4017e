// The outlines of those patches of a mesh that are plane.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/vector.h"

namespace lucerna::optics {

struct Mesh;

/// A patch is plane if its triangles are but for the digits that a file keeps. Its outline are the
/// sides of triangles around it and around its holes, straight runs of them joined. A patch that
/// lies on itself does not count as plane.
class MeshOutlines {
public:
    /// Vertices of the mesh. As the normal points to the reader, the patch lies on the left.
    using Side = std::array<std::uint32_t, 2>;

    MeshOutlines() = default;
    /// @param mesh    with normals, areas and patches.
    /// @param welded  for each vertex the first vertex at the same position
    MeshOutlines(const Mesh& mesh, const std::vector<std::uint32_t>& welded);

    /// Empty if the patch is not plane.
    std::span<const Side> of(std::uint32_t patch) const {
        return std::span(sides_).subspan(starts_[patch], starts_[patch + 1] - starts_[patch]);
    }
    bool is_plane(std::uint32_t patch) const { return starts_[patch + 1] > starts_[patch]; }
    /// How far points of a plane patch may lie from its plane [m]; their normals differ from that
    /// of the plane by at most tilt_rad.
    double tolerance_m() const { return tolerance_m_; }
    static constexpr double tilt_rad = 1e-4;

private:
    std::vector<Side> sides_;
    std::vector<std::size_t> starts_;  // one more than patches
    double tolerance_m_ = 0.0;
};

/// Area of the part of a plane patch that lies in the open ball around one of its points [m2];
/// exactly that of a disc where the outline stays out of the ball.
/// @param triangle  of the point.
double plane_area_in_ball_m2(const Mesh& mesh, std::uint32_t triangle, const Vec3& centre,
                             double radius_m);

}  // namespace lucerna::optics
