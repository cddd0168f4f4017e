// Where a ray meets an object.
#pragma once

#include <cstdint>

#include "core/vector.h"

namespace lucerna::optics {

using ObjectId = std::uint32_t;
inline constexpr ObjectId no_object = ~0u;

/// A point on the surface of an object.
///
/// `patch` numbers the smooth parts of an object's surface (the six faces of a box, side and caps
/// of a cylinder, regions of a mesh without a crease): kernels of the photon maps never reach
/// across a patch. `primitive` is the triangle of a mesh, else equal to `patch`.
struct SurfacePoint {
    Vec3 position = Vec3::Zero();
    Vec3 normal =
        Vec3::UnitZ();  ///< geometric, unit, outward for solids, else the front of the sheet
    ObjectId object = no_object;
    std::uint32_t patch = 0;
    std::uint32_t primitive = 0;
};

struct Hit {
    SurfacePoint point;
    double distance_m = infinity;
};

}  // namespace lucerna::optics
