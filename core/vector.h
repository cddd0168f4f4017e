// Vectors, rays and local frames. Lengths are in metres.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <numbers>

namespace lucerna {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;
using std::numbers::pi;

inline constexpr double infinity = std::numeric_limits<double>::infinity();
inline constexpr double rad_per_deg = pi / 180.0;

inline double square(double x) {
    return x * x;
}

/// A half line: `direction` is a unit vector.
struct Ray {
    Vec3 origin = Vec3::Zero();
    Vec3 direction = Vec3::UnitZ();
};

/// Right-handed orthonormal frame whose z axis is `normal`.
struct Frame {
    Vec3 tangent;
    Vec3 bitangent;
    Vec3 normal;

    /// Frame around a unit normal. Continuous but at -z (Duff et al., "Building an Orthonormal
    /// Basis, Revisited", JCGT 6(1), 2017).
    explicit Frame(const Vec3& n) : normal(n) {
        const double sign = std::copysign(1.0, n.z());
        const double a = -1.0 / (sign + n.z());
        const double b = n.x() * n.y() * a;
        tangent = Vec3(1.0 + sign * n.x() * n.x() * a, sign * b, -sign * n.x());
        bitangent = Vec3(b, sign + n.y() * n.y() * a, -n.y());
    }

    Frame(const Vec3& tangent_, const Vec3& bitangent_, const Vec3& normal_)
        : tangent(tangent_), bitangent(bitangent_), normal(normal_) {}

    Vec3 to_local(const Vec3& v) const { return {v.dot(tangent), v.dot(bitangent), v.dot(normal)}; }
    Vec3 to_world(const Vec3& v) const {
        return v.x() * tangent + v.y() * bitangent + v.z() * normal;
    }
};

/// Rigid motion from an object's own coordinates to the scene's.
using Placement = Eigen::Isometry3d;

}  // namespace lucerna
