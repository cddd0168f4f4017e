// Pictures for the eye of a luminance image; encoded for the display by OpenColorIO.
#pragma once

#include "io/raster.h"
#include "optics/transport/result.h"

namespace lucerna::io {

/// Share of the pixels with light whose luminance is at most `white_luminance * exposure_level` in
/// natural_preview.
inline constexpr double exposure_percentile = 0.95;
inline constexpr double exposure_level = 0.8;

/// The image in natural colours: exposed such that the 95th percentile of log luminance, over
/// pixels that are not black, is shown at 80 % of the display's white. Brighter parts clip.
struct NaturalPreview {
    Raster raster;
    double white_luminance;  ///< [cd/m2] that is shown as white
};
NaturalPreview natural_preview(const optics::Image& image);

/// The luminance on a logarithmic colour scale with its legend in cd/m2. The scale spans the 1st to
/// the 99th percentile of luminance, at least one decade and at most three below its upper end, out
/// to values 1, 2 or 5 times powers of ten. What is beyond, such as a lamp in view, has the colour
/// of the nearer end.
struct FalseColourPreview {
    Raster raster;
    double min_luminance, max_luminance;  ///< [cd/m2] ends of the scale
};
FalseColourPreview false_colour_preview(const optics::Image& image);

}  // namespace lucerna::io
