// What each shape can do, one set of functions per shape; shape.cpp chooses among them.
#pragma once

#include <optional>

#include "optics/geometry/shape.h"

namespace lucerna::optics {

/// Where a ray meets one shape.
struct ShapeHit {
    double distance_m;
    Vec3 position;  ///< on the surface up to rounding of its coordinates
    Vec3 normal;
    std::uint32_t patch;
    std::uint32_t primitive;
};

/// Nearest hit at a distance in (0, max_distance_m), in double precision.
///
/// @param start  point of this same shape from which the ray leaves, or nullptr. The root at the
///   origin is then left out in closed form. A ray that starts on an edge may hit the neighbouring
///   patch at distance 0.
std::optional<ShapeHit> intersect(const Shape& shape, const Ray& ray, const SurfacePoint* start,
                                  double max_distance_m);

namespace per_shape {

using OptionalHit = std::optional<ShapeHit>;
using Patch = std::uint32_t;

OptionalHit intersect(const Rectangle&, const Ray&, const SurfacePoint* start, double max);
Patch patch_count(const Rectangle&);
double patch_area_m2(const Rectangle&, Patch);
bool contains(const Rectangle&, const Vec3&);
Eigen::AlignedBox3d bounds(const Rectangle&);
SurfacePoint sample_area(const Rectangle&, double u1, double u2);
double kernel_area_m2(const Rectangle&, const SurfacePoint&, double radius_m);

OptionalHit intersect(const Box&, const Ray&, const SurfacePoint* start, double max);
Patch patch_count(const Box&);
double patch_area_m2(const Box&, Patch);
bool contains(const Box&, const Vec3&);
Eigen::AlignedBox3d bounds(const Box&);
SurfacePoint sample_area(const Box&, double u1, double u2);
double kernel_area_m2(const Box&, const SurfacePoint&, double radius_m);

OptionalHit intersect(const Disk&, const Ray&, const SurfacePoint* start, double max);
Patch patch_count(const Disk&);
double patch_area_m2(const Disk&, Patch);
bool contains(const Disk&, const Vec3&);
Eigen::AlignedBox3d bounds(const Disk&);
SurfacePoint sample_area(const Disk&, double u1, double u2);
double kernel_area_m2(const Disk&, const SurfacePoint&, double radius_m);

OptionalHit intersect(const Sphere&, const Ray&, const SurfacePoint* start, double max);
Patch patch_count(const Sphere&);
double patch_area_m2(const Sphere&, Patch);
bool contains(const Sphere&, const Vec3&);
Eigen::AlignedBox3d bounds(const Sphere&);
SurfacePoint sample_area(const Sphere&, double u1, double u2);
double kernel_area_m2(const Sphere&, const SurfacePoint&, double radius_m);

OptionalHit intersect(const Cylinder&, const Ray&, const SurfacePoint* start, double max);
Patch patch_count(const Cylinder&);
double patch_area_m2(const Cylinder&, Patch);
bool contains(const Cylinder&, const Vec3&);
Eigen::AlignedBox3d bounds(const Cylinder&);
SurfacePoint sample_area(const Cylinder&, double u1, double u2);
double kernel_area_m2(const Cylinder&, const SurfacePoint&, double radius_m);

OptionalHit intersect(const Tube&, const Ray&, const SurfacePoint* start, double max);
Patch patch_count(const Tube&);
double patch_area_m2(const Tube&, Patch);
bool contains(const Tube&, const Vec3&);
Eigen::AlignedBox3d bounds(const Tube&);
SurfacePoint sample_area(const Tube&, double u1, double u2);
double kernel_area_m2(const Tube&, const SurfacePoint&, double radius_m);

OptionalHit intersect(const MeshInstance&, const Ray&, const SurfacePoint* start, double max);
Patch patch_count(const MeshInstance&);
double patch_area_m2(const MeshInstance&, Patch);
bool contains(const MeshInstance&, const Vec3&);
Eigen::AlignedBox3d bounds(const MeshInstance&);
SurfacePoint sample_area(const MeshInstance&, double u1, double u2);
double kernel_area_m2(const MeshInstance&, const SurfacePoint&, double radius_m);
std::vector<std::array<Vec3, 2>> outline_near(const MeshInstance&, const SurfacePoint&,
                                              double radius_m);

/// The patch for a uniform number u, with probability in proportion to its area; u becomes a fresh
/// uniform number.
template <typename AnyShape>
Patch choose_patch(const AnyShape& shape, double& u) {
    double total = 0.0;
    for (Patch patch = 0; patch < patch_count(shape); ++patch) total += patch_area_m2(shape, patch);
    double rest = u * total;
    Patch patch = 0;
    while (patch + 1 < patch_count(shape) && rest >= patch_area_m2(shape, patch))
        rest -= patch_area_m2(shape, patch++);
    u = std::min(rest / patch_area_m2(shape, patch), 1.0);
    return patch;
}

}  // namespace per_shape

}  // namespace lucerna::optics
