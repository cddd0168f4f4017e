// Rays that leave a triangle of a mesh close to its edge, where single precision cannot decide.
#pragma once

#include "optics/geometry/mesh_search.h"

namespace lucerna::optics {

/// Whether a ray that leaves the triangle `start` can hit `triangle` at all, as far as their planes
/// tell: it must pass it from the side on which it runs, and the triangle must reach to that side.
bool can_hit_from(const Mesh& mesh, std::uint32_t start, std::uint32_t triangle,
                  const Vec3& direction);

/// True if p, a point of the triangle, is closer than `distance_m` to one of its edges.
bool near_edge(const Mesh& mesh, std::uint32_t triangle, const Vec3& p, double distance_m);

/// Nearest hit among the triangles that touch `start`, in double precision.
///
/// A ray on the edge of a concave corner hits the neighbour at distance 0 if it would pass it from
/// the side on which it runs; without that rule, rounding would let it slip out of a closed mesh.
/// @param ray  leaves the triangle `start`, in the mesh's coordinates
std::optional<TriangleHit> nearest_neighbour_hit(const Mesh& mesh, std::uint32_t start,
                                                 const Ray& ray);

/// The point of the triangle that the ray hits, given that it passes it within rounding.
///
/// @param distance_m  where the hit was found in single precision; replaced by the exact distance.
Vec3 refine_hit(const Mesh& mesh, std::uint32_t triangle, const Ray& ray, double& distance_m);

}  // namespace lucerna::optics
