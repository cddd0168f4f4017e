// Illuminance from polygons of uniform luminance.
#pragma once

#include <algorithm>
#include <vector>

#include "core/vector.h"

namespace lucerna::truth {

/// The part of a polygon above the plane through x with the given normal (Sutherland-Hodgman).
inline std::vector<Vec3> above_horizon(const std::vector<Vec3>& polygon, const Vec3& x,
                                       const Vec3& normal) {
    std::vector<Vec3> part;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Vec3& a = polygon[i];
        const Vec3& b = polygon[(i + 1) % polygon.size()];
        const double height_a = normal.dot(a - x);
        const double height_b = normal.dot(b - x);
        if (height_a >= 0.0) part.push_back(a);
        if ((height_a >= 0.0) != (height_b >= 0.0)) {
            part.push_back(a + height_a / (height_a - height_b) * (b - a));
        }
    }
    return part;
}

/// Illuminance [lx] at x from a polygon of uniform luminance that faces x.
///
///   E = L / 2 |sum over edges of angle(v_i, v_i+1) n . unit(v_i x v_i+1)|
///
/// with v the corners as seen from x (Lambert, Photometria, 1760, sections 138 to 143; in this form
/// Arvo, Analytic Methods for Simulated Light Transport, 1995, eq. 2.41).
inline double polygon_illuminance(const std::vector<Vec3>& polygon, double luminance, const Vec3& x,
                                  const Vec3& normal) {
    const std::vector<Vec3> seen = above_horizon(polygon, x, normal);
    double sum = 0.0;
    for (std::size_t i = 0; i < seen.size(); ++i) {
        const Vec3 a = seen[i] - x;
        const Vec3 b = seen[(i + 1) % seen.size()] - x;
        const Vec3 across = a.cross(b);
        const double length = across.norm();
        if (length > 0.0) sum += std::atan2(length, a.dot(b)) * normal.dot(across) / length;
    }
    return 0.5 * luminance * std::abs(sum);
}

/// The corners of a parallelogram.
inline std::vector<Vec3> corners(const Vec3& corner, const Vec3& u, const Vec3& v) {
    return {corner, corner + u, corner + u + v, corner + v};
}

}  // namespace lucerna::truth
