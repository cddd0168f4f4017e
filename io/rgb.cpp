#include "io/rgb.h"

#include <Eigen/LU>

namespace lucerna::io {
namespace {

// Colour of chromaticity (x, y) with Y = 1.
Vec3 xyz_of(double x, double y) {
    return {x / y, 1.0, (1.0 - x - y) / y};
}

Eigen::Matrix3d rgb_to_xyz() {
    Eigen::Matrix3d primaries;
    primaries << xyz_of(0.64, 0.33), xyz_of(0.30, 0.60), xyz_of(0.15, 0.06);
    const Vec3 luminance = primaries.inverse() * xyz_of(0.3127, 0.3290);  // of each at full drive
    return primaries * luminance.asDiagonal();
}

}  // namespace

const Eigen::Matrix3d& xyz_to_linear_rgb() {
    static const Eigen::Matrix3d matrix = rgb_to_xyz().inverse();
    return matrix;
}

Vec3 luminance_of_rgb() {
    return rgb_to_xyz().row(1);
}

}  // namespace lucerna::io
