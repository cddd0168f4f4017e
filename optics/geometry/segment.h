// The straight way between two points.
#pragma once

#include <algorithm>

#include "core/vector.h"

namespace lucerna::optics {

/// The point from a to b that is nearest to p.
inline Vec3 nearest_on_segment(const Vec3& a, const Vec3& b, const Vec3& p) {
    const Vec3 edge = b - a;
    return a + std::clamp((p - a).dot(edge) / edge.squaredNorm(), 0.0, 1.0) * edge;
}

}  // namespace lucerna::optics
