// The luminous opening of a luminaire: the surface that stands for it as a light source.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "core/vector.h"
#include "optics/geometry/mesh.h"

namespace lucerna::optics {

/// A luminous opening in the photometric frame (see IntensityDistribution), centred at the
/// photometric centre, as LM-63 and EULUMDAT state it.
struct Opening {
    enum class Kind {
        point,      ///< no size
        rectangle,  ///< flat; `axis` is its normal
        ellipse,    ///< flat; `axis` is its normal
        box,        ///< with luminous sides
        cylinder,   ///< along `axis`, of elliptic cross section, closed
        ellipsoid
    };
    enum class Axis { x, y, z };

    Kind kind = Kind::point;
    Vec3 size_m = Vec3::Zero();  ///< full extents along x (C0), y (C90), z (up)
    Axis axis = Axis::z;
    /// Luminous heights of the sides of a box that face C0, C90, C180 and C270; 0: a dark side.
    std::array<double, 4> side_heights_m = {};

    /// "rectangle 0.600 x 1.200 m", "vertical cylinder 0.149 x 0.149 x 0.124 m".
    std::string description() const;
};

/// Triangles of the opening (vertices and triangles only), or nothing for a point.
///
/// Faces are oriented outward. A flat opening is a single sheet whose normal points down (-z) if it
/// is horizontal, else along +x or +y. A box has its bottom, its top and those sides whose luminous
/// height is not 0, each from the bottom up to its own height; a dark side is left open. Bottom and
/// top are both luminous surfaces: whether light leaves there is said by the intensities alone.
/// Round shapes are polygons of 64 sides whose cross section has the area of the ellipse,
/// ellipsoids 32 x 16 facets scaled so that a sphere keeps its surface, and with it its mean
/// projected area.
std::optional<Mesh> opening_mesh(const Opening& opening);

}  // namespace lucerna::optics
