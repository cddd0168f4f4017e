#include "optics/geometry/mesh_outlines.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "optics/geometry/disc_area.h"
#include "optics/geometry/mesh.h"
#include "optics/geometry/segment.h"

namespace lucerna::optics {
namespace {

// Of the size of the mesh: files keep six digits and more.
constexpr double relative_tolerance = 2e-6;
// The same for sides that count as one, so that areas keep five digits of kernels a thousandth of
// the mesh.
constexpr double relative_tolerance_of_sides = 1e-8;
// Sides joined to one at a time, so that the search for straight runs stays linear.
constexpr std::size_t most_joined = 64;

double size_m(const Mesh& mesh) {
    Eigen::AlignedBox3d box;
    for (const auto& triangle : mesh.triangles) {
        for (const std::uint32_t vertex : triangle) box.extend(mesh.vertices[vertex]);
    }
    return box.diagonal().norm();
}

// Whether each patch is plane.
std::vector<bool> find_plane(const Mesh& mesh, double tolerance_m) {
    const std::size_t patches = mesh.patch_areas_m2.size();
    std::vector<Vec3> normals(patches, Vec3::Zero()), centres(patches, Vec3::Zero());
    const Vec3 reference = mesh.vertices[mesh.triangles.front()[0]];
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const auto& [a, b, c] = mesh.triangles[i];
        const std::uint32_t patch = mesh.patches[i];
        const double share = mesh.areas_m2[i] / mesh.patch_areas_m2[patch];
        normals[patch] += share * mesh.normals[i];
        centres[patch] += share / 3.0 *
                          ((mesh.vertices[a] - reference) + (mesh.vertices[b] - reference) +
                           (mesh.vertices[c] - reference));
    }
    for (Vec3& normal : normals) normal.normalize();  // 0 stays 0
    std::vector<bool> plane(patches, true);
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const std::uint32_t patch = mesh.patches[i];
        const Vec3& normal = normals[patch];
        if (!(mesh.normals[i].cross(normal).norm() < MeshOutlines::tilt_rad) ||
            !(mesh.normals[i].dot(normal) > 0.0)) {
            plane[patch] = false;
        }
        for (const std::uint32_t vertex : mesh.triangles[i]) {
            const Vec3 offset = mesh.vertices[vertex] - reference - centres[patch];
            if (!(std::abs(normal.dot(offset)) < tolerance_m)) plane[patch] = false;
        }
    }
    return plane;
}

// Whether the points between two of a row lie on the straight line between them.
bool is_straight(const Mesh& mesh, std::span<const std::uint32_t> row, double tolerance_m) {
    const Vec3& start = mesh.vertices[row.front()];
    const Vec3 way = mesh.vertices[row.back()] - start;
    double before = 0.0;
    for (std::size_t i = 1; i + 1 < row.size(); ++i) {
        const Vec3 offset = mesh.vertices[row[i]] - start;
        const double along = offset.dot(way);
        if (along <= before || along >= way.squaredNorm()) return false;
        if (offset.cross(way).norm() > tolerance_m * way.norm()) return false;
        before = along;
    }
    return true;
}

// The sides of triangles of a patch that no other of them has the other way round; none if the
// patch lies on itself.
std::vector<MeshOutlines::Side> sides_around(const Mesh& mesh,
                                             const std::vector<std::uint32_t>& welded,
                                             std::span<const std::uint32_t> triangles) {
    std::vector<MeshOutlines::Side> all;
    for (const std::uint32_t triangle : triangles) {
        const auto& corners = mesh.triangles[triangle];
        for (std::size_t k = 0; k < 3; ++k) {
            all.push_back({welded[corners[k]], welded[corners[(k + 1) % 3]]});
        }
    }
    std::ranges::sort(all);
    std::vector<MeshOutlines::Side> around;
    if (std::ranges::adjacent_find(all) != all.end()) return around;
    for (const MeshOutlines::Side& side : all) {
        const MeshOutlines::Side back{side[1], side[0]};
        if (!std::ranges::binary_search(all, back)) around.push_back(side);
    }
    return around;
}

// Chains of sides, each from where the last one ended; a chain ends where several meet.
// @param sides  sorted
std::vector<std::vector<std::uint32_t>> chains_of(const std::vector<MeshOutlines::Side>& sides) {
    std::vector<bool> used(sides.size());
    std::vector<std::vector<std::uint32_t>> chains;
    for (std::size_t first = 0; first < sides.size(); ++first) {
        if (used[first]) continue;
        std::vector<std::uint32_t> chain{sides[first][0]};
        for (std::size_t next = first; !used[next];) {
            used[next] = true;
            chain.push_back(sides[next][1]);
            const auto on = std::ranges::equal_range(
                sides, chain.back(), {}, [](const MeshOutlines::Side& side) { return side[0]; });
            if (on.size() != 1) break;
            next = static_cast<std::size_t>(on.begin() - sides.begin());
        }
        chains.push_back(std::move(chain));
    }
    return chains;
}

// Starts a ring at a corner, if it has one.
void turn_to_corner(const Mesh& mesh, std::vector<std::uint32_t>& chain, double tolerance_m) {
    if (chain.front() != chain.back()) return;
    chain.pop_back();
    const std::size_t n = chain.size();
    std::size_t corner = 0;
    const auto straight_at = [&](std::size_t i) {
        const std::array row{chain[(i + n - 1) % n], chain[i], chain[(i + 1) % n]};
        return is_straight(mesh, row, tolerance_m);
    };
    while (corner + 1 < n && straight_at(corner)) ++corner;
    std::rotate(chain.begin(), chain.begin() + static_cast<std::ptrdiff_t>(corner), chain.end());
    chain.push_back(chain.front());
}

// Leaves out points between others on straight lines; true if there were any.
bool join_straight_runs(const Mesh& mesh, std::vector<std::uint32_t>& chain, double tolerance_m) {
    std::vector<std::uint32_t> joined{chain.front()};
    for (std::size_t i = 0, end; i + 1 < chain.size(); i = end) {
        end = i + 1;
        while (end + 1 < chain.size() && end - i < most_joined &&
               is_straight(mesh, std::span(chain).subspan(i, end + 2 - i), tolerance_m)) {
            ++end;
        }
        joined.push_back(chain[end]);
    }
    const bool fewer = joined.size() < chain.size();
    chain = std::move(joined);
    return fewer;
}

}  // namespace

MeshOutlines::MeshOutlines(const Mesh& mesh, const std::vector<std::uint32_t>& welded) {
    const double mesh_m = size_m(mesh);
    tolerance_m_ = relative_tolerance * mesh_m;
    const double straight_m = relative_tolerance_of_sides * mesh_m;
    const std::vector<bool> plane = find_plane(mesh, tolerance_m_);
    std::vector<std::uint32_t> order(mesh.triangles.size());
    std::iota(order.begin(), order.end(), 0u);
    std::ranges::stable_sort(order, {}, [&](std::uint32_t i) { return mesh.patches[i]; });
    starts_.assign(plane.size() + 1, 0);
    auto end = order.begin();
    for (std::uint32_t patch = 0; patch < plane.size(); ++patch) {
        const auto begin = end;
        while (end != order.end() && mesh.patches[*end] == patch) ++end;
        if (plane[patch]) {
            for (auto& chain : chains_of(sides_around(mesh, welded, {begin, end}))) {
                turn_to_corner(mesh, chain, straight_m);
                while (join_straight_runs(mesh, chain, straight_m)) {
                }
                for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
                    sides_.push_back({chain[i], chain[i + 1]});
                }
            }
        }
        starts_[patch + 1] = sides_.size();
    }
    sides_.shrink_to_fit();
}

double plane_area_in_ball_m2(const Mesh& mesh, std::uint32_t triangle, const Vec3& centre,
                             double radius_m) {
    const std::span<const MeshOutlines::Side> sides = mesh.outlines.of(mesh.patches[triangle]);
    const double square_m2 = radius_m * radius_m;
    const bool whole = std::ranges::none_of(sides, [&](const MeshOutlines::Side& side) {
        const Vec3& a = mesh.vertices[side[0]];
        const Vec3& b = mesh.vertices[side[1]];
        return (nearest_on_segment(a, b, centre) - centre).squaredNorm() < square_m2;
    });
    if (whole) return pi * square_m2;
    // Green's theorem: what a side adds, is the signed area between it and the centre.
    const Frame frame(mesh.normals[triangle]);
    const auto in_plane = [&](std::uint32_t vertex) {
        return Vec2(frame.to_local(mesh.vertices[vertex] - centre).head<2>());
    };
    double area_m2 = 0.0;
    for (const auto& [from, to] : sides) {
        area_m2 += disc_edge_area(in_plane(from), in_plane(to), radius_m);
    }
    return std::max(area_m2, 0.0);
}

}  // namespace lucerna::optics
