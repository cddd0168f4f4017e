// Meshes of known solids for tests.
#pragma once

#include "optics/geometry/mesh.h"

namespace lucerna::test {

/// A box [0, size] with steps x steps squares of two triangles on each face, normals outward.
inline std::shared_ptr<const optics::Mesh> box_mesh(const Vec3& size, std::uint32_t steps) {
    std::vector<Vec3> vertices;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    for (int axis = 0; axis < 3; ++axis) {
        for (const bool far_face : {false, true}) {
            const auto first = static_cast<std::uint32_t>(vertices.size());
            const int u = (axis + 1) % 3;
            const int v = (axis + 2) % 3;
            for (std::uint32_t i = 0; i <= steps; ++i) {
                for (std::uint32_t j = 0; j <= steps; ++j) {
                    Vec3 vertex = Vec3::Zero();
                    vertex[axis] = far_face ? size[axis] : 0.0;
                    vertex[u] = size[u] * i / steps;
                    vertex[v] = size[v] * j / steps;
                    vertices.push_back(vertex);
                }
            }
            for (std::uint32_t i = 0; i < steps; ++i) {
                for (std::uint32_t j = 0; j < steps; ++j) {
                    const std::uint32_t a = first + i * (steps + 1) + j;
                    const std::uint32_t b = a + steps + 1;
                    if (far_face) {
                        triangles.push_back({a, b, b + 1});
                        triangles.push_back({a, b + 1, a + 1});
                    } else {
                        triangles.push_back({a, b + 1, b});
                        triangles.push_back({a, a + 1, b + 1});
                    }
                }
            }
        }
    }
    return optics::prepare_mesh(std::move(vertices), std::move(triangles));
}

/// A sphere of `rings` zones of latitude and twice as many sectors, vertices on the radius.
inline std::shared_ptr<const optics::Mesh> sphere_mesh(double radius_m, std::uint32_t rings) {
    const std::uint32_t sectors = 2 * rings;
    std::vector<Vec3> vertices{{0, 0, radius_m}, {0, 0, -radius_m}};
    const auto at = [&](std::uint32_t ring, std::uint32_t sector) {
        return 2 + (ring - 1) * sectors + sector % sectors;
    };
    for (std::uint32_t ring = 1; ring < rings; ++ring) {
        for (std::uint32_t sector = 0; sector < sectors; ++sector) {
            const double polar = pi * ring / rings;
            const double azimuth = 2.0 * pi * sector / sectors;
            vertices.push_back(radius_m * Vec3(std::sin(polar) * std::cos(azimuth),
                                               std::sin(polar) * std::sin(azimuth),
                                               std::cos(polar)));
        }
    }
    std::vector<std::array<std::uint32_t, 3>> triangles;
    for (std::uint32_t sector = 0; sector < sectors; ++sector) {
        triangles.push_back({0, at(1, sector), at(1, sector + 1)});
        triangles.push_back({1, at(rings - 1, sector + 1), at(rings - 1, sector)});
        for (std::uint32_t ring = 1; ring + 1 < rings; ++ring) {
            triangles.push_back({at(ring, sector), at(ring + 1, sector), at(ring + 1, sector + 1)});
            triangles.push_back({at(ring, sector), at(ring + 1, sector + 1), at(ring, sector + 1)});
        }
    }
    return optics::prepare_mesh(std::move(vertices), std::move(triangles));
}

}  // namespace lucerna::test
