// An 8-bit picture for a display.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace lucerna::io {

using Rgb8 = std::array<std::uint8_t, 3>;  ///< encoded for an sRGB display

/// Row 0 is the top row.
struct Raster {
    int width = 0, height = 0;
    std::vector<Rgb8> pixels;

    Raster(int w, int h, Rgb8 fill)
        : width(w),
          height(h),
          pixels(static_cast<std::size_t>(w) * static_cast<std::size_t>(h), fill) {}
    Rgb8& at(int x, int y) {
        return pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                      static_cast<std::size_t>(x)];
    }
};

/// Writes an RGB PNG that is marked as sRGB.
void write_png(const std::filesystem::path& path, const Raster& raster);

}  // namespace lucerna::io
