// Portable float maps, the plainest exchange format of luminance images.
#pragma once

#include <filesystem>

#include "io/luminance_image.h"

namespace lucerna::io {

/// Reads "Pf" (luminance) or "PF" (R, G, B, weighted to luminance by BT.709). The file's rows run
/// from bottom to top; the sign of its scale gives the byte order, its magnitude multiplies the
/// values. Throws InputError.
LuminanceImage read_pfm(const std::filesystem::path& path);

}  // namespace lucerna::io
