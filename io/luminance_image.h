// An image of luminances as read from a file, to be compared.
#pragma once

#include <filesystem>
#include <vector>

#include "core/vector.h"

namespace lucerna::io {

/// Row 0 is the top row.
struct LuminanceImage {
    int width = 0, height = 0;
    std::vector<double> luminance;       ///< per pixel, finite [cd/m2, or the unit of the file]
    std::vector<double> standard_error;  ///< per pixel, or empty where the file states none
};

/// More pixels than this are taken for a damaged header (16384 squared).
inline constexpr long max_pixels = 1L << 28;

/// Weights of linear R, G, B in luminance: Y of the primaries of ITU-R BT.709 (0.2126, 0.7152,
/// 0.0722).
Vec3 luminance_of_rgb();

/// Reads an OpenEXR or PFM image, told apart by their first bytes. Throws InputError.
LuminanceImage read_image(const std::filesystem::path& path);

}  // namespace lucerna::io
