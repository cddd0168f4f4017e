// An image of luminances as read from a file, to be compared.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "core/vector.h"

namespace lucerna::io {

/// Row 0 is the top row. Images of Lucerna state their errors, taken over the phases of their run;
/// other files do not.
struct LuminanceImage {
    int width = 0, height = 0;
    std::vector<double> luminance;       ///< per pixel, finite [cd/m2, or the unit of the file]
    std::vector<double> standard_error;  ///< per pixel, or empty
    std::vector<double>
        tile_standard_error;  ///< of the means of optics::Image::tiles, row by row, or empty
    std::optional<double> mean_standard_error;  ///< of the mean of all pixels
    std::uint32_t phases = 0;                   ///< that the errors rest on; 0: unknown
};

/// More pixels than this are taken for a damaged header (16384 squared).
inline constexpr long max_pixels = 1L << 28;

/// Weights of linear R, G, B in luminance: Y of the primaries of ITU-R BT.709 (0.2126, 0.7152,
/// 0.0722).
Vec3 luminance_of_rgb();

/// Reads an OpenEXR or PFM image, told apart by their first bytes. Throws InputError.
LuminanceImage read_image(const std::filesystem::path& path);

}  // namespace lucerna::io
