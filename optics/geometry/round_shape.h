// What cylinders and tubes have in common: round sides and flat ends.
#pragma once

#include "optics/geometry/axial_frame.h"
#include "optics/geometry/shape_parts.h"

namespace lucerna::optics::per_shape {

/// Hit of a round side at the local point p, which is moved onto the side.
/// @param outward  +1 if the normal points away from the axis, else -1.
ShapeHit side_hit(const AxialFrame&, Vec3 p, double radius_m, double outward, double t, Patch);

/// Hit of a flat end (annulus) at the local point p, which is moved onto it.
ShapeHit end_hit(const AxialFrame&, Vec3 p, double inner_radius_m, double radius_m, bool at_to,
                 double t, Patch);

SurfacePoint sample_side(const AxialFrame&, double radius_m, double outward, Patch, double u1,
                         double u2);
SurfacePoint sample_end(const AxialFrame&, double inner_radius_m, double radius_m, bool at_to,
                        Patch, double u1, double u2);

/// Area of the part of the side that is nearer to p than `kernel_radius_m` on the unrolled side.
double side_kernel_area_m2(const AxialFrame&, double radius_m, const Vec3& p,
                           double kernel_radius_m);

}  // namespace lucerna::optics::per_shape
