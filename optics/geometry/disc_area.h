// Areas of a disc cut by plane figures, in closed form.
#pragma once

#include <span>

#include "core/vector.h"

namespace lucerna::optics {

/// Signed area of the part of the triangle (0, a, b) that lies in the disc around 0; positive if
/// that runs counterclockwise.
double disc_edge_area(const Vec2& a, const Vec2& b, double radius);

/// Area of the part of a disc around the origin that lies inside a simple polygon.
///
/// @param polygon  corners in order; the area is negative if they run clockwise.
double disc_polygon_area(std::span<const Vec2> polygon, double radius);

/// Area of the part of a disc around (x, y) that lies in [0, width] x [0, height].
double disc_rectangle_area(double x, double y, double width, double height, double radius);

/// Area common to two discs whose centres are `distance` apart.
double disc_disc_area(double distance, double radius_1, double radius_2);

}  // namespace lucerna::optics
