// Shapes in general position and random rays, shared by the geometry tests.
#pragma once

#include <array>
#include <vector>

#include "core/random.h"
#include "core/sampling.h"
#include "optics/geometry/shape.h"

namespace lucerna::optics {

inline RandomStream test_stream(std::uint32_t path) {
    return RandomStream(20240917, 0, RandomPurpose::test, path);
}

inline Vec3 random_direction(RandomStream& random) {
    const double u1 = random.uniform();
    return sample_sphere(u1, random.uniform());
}

inline Vec3 random_point(RandomStream& random, double half_width) {
    const double x = random.uniform();
    const double y = random.uniform();
    return half_width * Vec3(2.0 * x - 1.0, 2.0 * y - 1.0, 2.0 * random.uniform() - 1.0);
}

inline Placement general_placement() {
    Placement placement = Placement::Identity();
    placement.translate(Vec3(0.3, -0.2, 0.5));
    placement.rotate(Eigen::AngleAxisd(0.7, Vec3(1.0, 2.0, -0.5).normalized()));
    return placement;
}

/// Direction on the side of the surface that `side` says (+1: the normal's), cosine-distributed.
inline Vec3 scattered(const Vec3& normal, double side, RandomStream& random) {
    const double u1 = random.uniform();
    return Frame(side * normal).to_world(sample_cosine_hemisphere(u1, random.uniform()));
}

inline Vec3 mirrored(const Vec3& direction, const Vec3& normal) {
    return (direction - 2.0 * direction.dot(normal) * normal).normalized();
}

/// Closed box [0, size] of 12 triangles, oriented outward.
inline std::shared_ptr<const Mesh> box_mesh(const Vec3& size) {
    std::vector<Vec3> vertices;
    for (int i = 0; i < 8; ++i)
        vertices.push_back(size.cwiseProduct(Vec3(i & 1, (i >> 1) & 1, (i >> 2) & 1)));
    return prepare_mesh(vertices, {{0, 2, 3},
                                   {0, 3, 1},
                                   {4, 5, 7},
                                   {4, 7, 6},
                                   {0, 1, 5},
                                   {0, 5, 4},
                                   {2, 6, 7},
                                   {2, 7, 3},
                                   {0, 4, 6},
                                   {0, 6, 2},
                                   {1, 3, 7},
                                   {1, 7, 5}});
}

/// Closed sphere of latitude and longitude triangles, oriented outward.
inline std::shared_ptr<const Mesh> sphere_mesh(double radius_m, std::uint32_t rings,
                                               std::uint32_t segments) {
    std::vector<Vec3> vertices{Vec3(0, 0, radius_m)};
    for (std::uint32_t i = 1; i < rings; ++i)
        for (std::uint32_t j = 0; j < segments; ++j) {
            const double polar = pi * i / rings;
            const double azimuth = 2.0 * pi * j / segments;
            vertices.push_back(radius_m * Vec3(std::sin(polar) * std::cos(azimuth),
                                               std::sin(polar) * std::sin(azimuth),
                                               std::cos(polar)));
        }
    const auto south = static_cast<std::uint32_t>(vertices.size());
    vertices.push_back(Vec3(0, 0, -radius_m));
    std::vector<std::array<std::uint32_t, 3>> triangles;
    const auto at = [&](std::uint32_t ring, std::uint32_t j) {
        return 1 + (ring - 1) * segments + j % segments;
    };
    for (std::uint32_t j = 0; j < segments; ++j) {
        triangles.push_back({0, at(1, j), at(1, j + 1)});
        for (std::uint32_t i = 1; i + 1 < rings; ++i) {
            triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
        triangles.push_back({south, at(rings - 1, j + 1), at(rings - 1, j)});
    }
    return prepare_mesh(vertices, triangles);
}

/// One of each, in general position.
inline std::vector<Shape> one_of_each() {
    const Vec3 axis = Vec3(0.4, 0.5, -0.3).normalized();
    const Frame frame(axis);
    return {Rectangle{Vec3(-0.4, 0.1, 0.2), 0.9 * frame.tangent, 0.5 * frame.bitangent},
            Box{general_placement(), Vec3(0.5, 0.8, 0.3)},
            Disk{Vec3(0.1, 0.2, -0.3), axis, 0.6, 0.0},
            Disk{Vec3(-0.1, 0.2, 0.3), axis, 0.7, 0.25},
            Sphere{Vec3(0.2, -0.1, 0.1), 0.6},
            Cylinder{Vec3(-0.3, 0.1, -0.4), Vec3(0.2, 0.4, 0.5), 0.35},
            Tube{Vec3(-0.3, 0.1, -0.4), Vec3(0.2, 0.4, 0.5), 0.45, 0.3},
            MeshInstance{box_mesh(Vec3(0.5, 0.8, 0.3)), general_placement()},
            MeshInstance{sphere_mesh(0.5, 12, 24), general_placement()}};
}

}  // namespace lucerna::optics
