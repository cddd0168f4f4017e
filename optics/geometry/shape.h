// The shapes of objects. Exact shapes are intersected in double precision; see ray_caster.h.
#pragma once

#include <memory>
#include <optional>
#include <variant>
#include <vector>

#include "optics/geometry/mesh.h"
#include "optics/geometry/surface.h"

namespace lucerna::optics {

/// Parallelogram with right angles: corner + s * edge_u + t * edge_v, s and t in [0, 1].
/// The normal is edge_u x edge_v. One patch.
struct Rectangle {
    Vec3 corner, edge_u, edge_v;
};

/// Solid box: `placement` maps [0, size.x] x [0, size.y] x [0, size.z] into the scene.
/// Patches: 0 -x, 1 +x, 2 -y, 3 +y, 4 -z, 5 +z.
struct Box {
    Placement placement;
    Vec3 size_m;
};

/// Flat disk (or annulus when inner_radius_m > 0) with a unit normal. One patch.
struct Disk {
    Vec3 centre, normal;
    double radius_m;
    double inner_radius_m = 0.0;
};

/// Solid ball; the normal points outward. One patch.
struct Sphere {
    Vec3 centre;
    double radius_m;
};

/// Solid right circular cylinder. Patches: 0 side, 1 cap at `from`, 2 cap at `to`.
struct Cylinder {
    Vec3 from, to;
    double radius_m;
};

/// Solid tube (the wall between two coaxial cylinders).
/// Patches: 0 outer side, 1 inner side, 2 annulus at `from`, 3 annulus at `to`.
struct Tube {
    Vec3 from, to;
    double radius_m;
    double inner_radius_m;
};

/// A triangle mesh placed in the scene; many instances share one mesh.
struct MeshInstance {
    std::shared_ptr<const Mesh> mesh;
    Placement placement;
};

/// Closed list: a missing case is a compile error.
using Shape = std::variant<Rectangle, Box, Disk, Sphere, Cylinder, Tube, MeshInstance>;

/// Area of the surface [m2].
double area_m2(const Shape& shape);
/// Area of one patch [m2].
double patch_area_m2(const Shape& shape, std::uint32_t patch);
std::uint32_t patch_count(const Shape& shape);
/// True if the surface encloses a volume (a mesh: closed and oriented).
bool is_solid(const Shape& shape);
/// True if p lies inside a solid shape (boundary: either).
bool contains(const Shape& shape, const Vec3& p);
/// Axis-aligned bounds.
Eigen::AlignedBox3d bounds(const Shape& shape);
/// Point on the surface, uniform per area; `object` is left for the caller to set.
SurfacePoint sample_area(const Shape& shape, double u1, double u2);

/// Area of the kernel around a surface point: { x in the same patch : |x - p| < radius } [m2].
/// For a Cylinder or Tube side the distance is that of the unrolled surface (see within_kernel).
/// Exact for all shapes, for a mesh as the sum over its plane triangles: the area of the surface as
/// it is meshed, not of the smooth one that the mesh stands for.
double kernel_area_m2(const Shape& shape, const SurfacePoint& p, double radius_m);

/// True if the patch lies in a plane; that of a mesh but for the digits of its file.
bool is_plane(const Shape& shape, std::uint32_t patch);

/// Sides of the outline of a patch where it is plane and they are straight: all of them, or of a
/// mesh those that are closer to the point than the radius.
std::vector<std::array<Vec3, 2>> outline_near(const Shape& shape, const SurfacePoint& p,
                                              double radius_m);

/// How far from the plane through one of its points, along its normal, those of a plane patch may
/// lie that are closer than the radius [m].
double off_plane_m(const Shape& shape, double radius_m);

/// True if kernels of the patch take distances along the unrolled surface; else they are straight.
bool unrolls(const Shape& shape, std::uint32_t patch);

/// True if q lies in the kernel of p: same object and patch, and closer than the radius.
/// @param object_shape  the shape of p's object.
bool within_kernel(const Shape& object_shape, const SurfacePoint& p, const SurfacePoint& q,
                   double radius_m);

}  // namespace lucerna::optics
