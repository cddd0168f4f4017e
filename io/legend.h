// The scale beside a false-colour image.
#pragma once

#include <functional>
#include <string_view>
#include <vector>

#include "io/raster.h"

namespace lucerna::io {

/// The values 1, 2 and 5 times powers of ten within [min, max], both > 0.
std::vector<double> log_ticks(double min, double max);

/// Draws digits and the letters of "cd/m²" with its top left corner at (x, y); a character is 5 x 7
/// blocks of `block` pixels. Other characters are blank. Parts outside the picture are left out.
void draw_text(Raster& raster, int x, int y, std::u32string_view text, int block, Rgb8 colour);

/// Width in pixels of the strip that draw_legend fills.
int legend_width(int block);

/// Draws a logarithmic scale from min (bottom) to max (top) in cd/m2 into the columns from x on.
/// @param colour_of colour of a position in [0, 1].
void draw_legend(Raster& raster, int x, int block, double min, double max,
                 const std::function<Rgb8(double)>& colour_of);

}  // namespace lucerna::io
