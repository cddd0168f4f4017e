// The colours of false-colour images.
#pragma once

#include "core/vector.h"

namespace lucerna::io {

/// Colour of t in [0, 1] as XYZ with Y = 1 for the display's D65 white. From dark violet over red
/// to light yellow: lightness rises at a constant rate, so that the order is seen in grey as well
/// and by the colour-blind. All colours lie within sRGB.
Vec3 false_colour_xyz(double t);

}  // namespace lucerna::io
