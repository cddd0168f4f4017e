// From colour to what a display is sent.
#pragma once

#include <array>
#include <vector>

#include "io/raster.h"

namespace lucerna::io {

/// Encodes XYZ, Y = 1 for the display's D65 white, for an sRGB display by the transform of
/// data/ocio/config.ocio. Colours outside sRGB are clipped channel by channel.
std::vector<Rgb8> encode_for_display(std::vector<std::array<float, 3>> xyz);

}  // namespace lucerna::io
