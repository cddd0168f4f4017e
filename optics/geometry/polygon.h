// Polygons cut into triangles.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/vector.h"

namespace lucerna::optics {

/// Cuts a simple polygon, convex or not, into triangles of the same orientation by cutting off
/// ears.
///
/// @param corners  in order, in or near a plane
/// @return indices into `corners`, three each; nothing if the polygon crosses itself or has no
/// area.
///   Corners on a straight line yield triangles without area where no other cut is left.
std::optional<std::vector<std::array<std::uint32_t, 3>>> triangulate_polygon(
    std::span<const Vec3> corners);

}  // namespace lucerna::optics
