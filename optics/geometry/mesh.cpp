#include "optics/geometry/mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <tuple>

#include "optics/geometry/mesh_edges.h"
#include "optics/geometry/mesh_search.h"

namespace lucerna::optics {

namespace {

void check(const Mesh& mesh) {
    if (mesh.triangles.empty()) throw std::invalid_argument("a mesh needs at least one triangle");
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
        if (!mesh.vertices[i].allFinite())
            throw std::invalid_argument(fmt::format("vertex {} is not finite", i));
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        for (const std::uint32_t vertex : mesh.triangles[i])
            if (vertex >= mesh.vertices.size())
                throw std::invalid_argument(fmt::format("triangle {} refers to vertex {} of {}", i,
                                                        vertex, mesh.vertices.size()));
}

void add_normals_and_areas(Mesh& mesh) {
    double sum_m2 = 0.0;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const auto& [a, b, c] = mesh.triangles[i];
        const Vec3 twice_area =
            (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]);
        const double norm = twice_area.norm();
        if (!(0.5 * norm > smallest_triangle_m2 && std::isfinite(norm)))
            throw std::invalid_argument(
                fmt::format("triangle {} has no area, or one beyond all bounds", i));
        mesh.normals.push_back(twice_area / norm);
        mesh.areas_m2.push_back(0.5 * norm);
        mesh.cumulative_area_m2.push_back(sum_m2 += 0.5 * norm);
    }
}

/// Disjoint sets of triangles, each known by its smallest member.
class Regions {
public:
    explicit Regions(std::size_t size) : parent_(size) {
        std::iota(parent_.begin(), parent_.end(), 0u);
    }
    std::uint32_t find(std::uint32_t i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    void join(std::uint32_t i, std::uint32_t j) {
        const auto [low, high] = std::minmax({find(i), find(j)});
        parent_[high] = low;
    }

private:
    std::vector<std::uint32_t> parent_;
};

/// Joins triangles to patches; returns whether each edge has two triangles of like orientation.
bool add_patches(Mesh& mesh, const std::vector<std::uint32_t>& welded) {
    Regions regions(mesh.triangles.size());
    bool watertight = true;
    for_each_edge(mesh, welded, [&](std::span<const TriangleSide> sides) {
        if (edge_kind(sides) != EdgeKind::regular) {
            watertight = false;
            return;
        }
        const std::uint32_t i = sides[0].triangle;
        const std::uint32_t j = sides[1].triangle;
        if (mesh.normals[i].dot(mesh.normals[j]) > std::cos(crease_angle_rad)) regions.join(i, j);
    });
    mesh.patches.resize(mesh.triangles.size());
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        const std::uint32_t first = regions.find(i);
        if (first == i) {
            mesh.patches[i] = static_cast<std::uint32_t>(mesh.patch_areas_m2.size());
            mesh.patch_areas_m2.push_back(0.0);
        } else {
            mesh.patches[i] = mesh.patches[first];
        }
        mesh.patch_areas_m2[mesh.patches[i]] += mesh.areas_m2[i];
    }
    return watertight;
}

/// Volume enclosed, negative if the normals point inward (divergence theorem).
double signed_volume_m3(const Mesh& mesh) {
    const Vec3 reference = mesh.vertices[mesh.triangles.front()[0]];
    double sum = 0.0;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        sum +=
            mesh.areas_m2[i] * mesh.normals[i].dot(mesh.vertices[mesh.triangles[i][0]] - reference);
    return sum / 3.0;
}

}  // namespace

std::vector<std::uint32_t> weld_vertices(const std::vector<Vec3>& vertices) {
    const auto key = [&](std::uint32_t i) {
        // + 0.0 makes -0 and 0 the same
        return std::tuple(vertices[i].x() + 0.0, vertices[i].y() + 0.0, vertices[i].z() + 0.0);
    };
    std::vector<std::uint32_t> order(vertices.size());
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(), [&](std::uint32_t i, std::uint32_t j) {
        return std::tuple_cat(key(i), std::tuple(i)) < std::tuple_cat(key(j), std::tuple(j));
    });
    std::vector<std::uint32_t> welded(vertices.size());
    for (std::size_t i = 0; i < order.size(); ++i)
        welded[order[i]] =
            i > 0 && key(order[i]) == key(order[i - 1]) ? welded[order[i - 1]] : order[i];
    return welded;
}

std::shared_ptr<const Mesh> prepare_mesh(std::vector<Vec3> vertices,
                                         std::vector<std::array<std::uint32_t, 3>> triangles) {
    auto mesh = std::make_shared<Mesh>();
    mesh->vertices = std::move(vertices);
    mesh->triangles = std::move(triangles);
    check(*mesh);
    add_normals_and_areas(*mesh);
    std::vector<std::uint32_t> welded = weld_vertices(mesh->vertices);
    mesh->closed = add_patches(*mesh, welded) && signed_volume_m3(*mesh) > 0.0;
    mesh->outlines = MeshOutlines(*mesh, welded);
    mesh->search = std::make_shared<MeshSearch>(*mesh, std::move(welded));
    return mesh;
}

}  // namespace lucerna::optics
