// Tristimulus values as linear RGB of the display primaries.
#pragma once

#include "core/vector.h"

namespace lucerna::io {

/// XYZ -> linear R, G, B of the primaries and white point of ITU-R BT.709-6 (item 1.3 and 1.4),
/// which sRGB (IEC 61966-2-1) shares. R = G = B = 1 is D65 white with Y = 1, so RGB has the unit of
/// Y.
const Eigen::Matrix3d& xyz_to_linear_rgb();

/// Y of linear R, G, B: the second row of the inverse of the above (0.2126, 0.7152, 0.0722).
Vec3 luminance_of_rgb();

}  // namespace lucerna::io
