// How far an image is from a reference, with the noise of both.
#pragma once

#include <optional>
#include <string>

#include "io/luminance_image.h"

namespace lucerna::io {

/// A number and the half width of the 95 % interval of its noise; without a width where no image
/// states its errors.
struct BoundedValue {
    double value = 0.0;
    std::optional<double> expanded_uncertainty;
};

/// The tile of 16 x 16 pixels whose mean luminance is furthest from the reference's.
struct WorstTile {
    int x = 0, y = 0;             ///< its top left pixel
    double reference_mean = 0.0;  ///< [cd/m2]
    double image_mean = 0.0;      ///< [cd/m2]
    BoundedValue
        difference;  ///< image_mean - reference_mean, relative to the mean of the whole reference
};

/// How the tiles of two images that state their errors agree.
struct TileAgreement {
    /// Largest |difference of means| in standard errors of the difference, and its tile's corner.
    double largest_deviation = 0.0;
    int x = 0, y = 0;
    /// Median over the tiles of the standard error of the difference, relative to the reference's
    /// mean in that tile; tiles that are black are left out.
    double median_relative_error = 0.0;
};

/// Sums run over the pixels that count.
///
/// Pixels of one run share photons and wavelengths, so the noise of a mean does not follow from
/// theirs. It is taken from the file where that states it; else, and under a mask, it is bounded by
/// the mean of the standard errors, which holds for any correlation. The bound of the RMSE takes
/// pixels as independent. Kernel bias is a part of what is compared, not of the bounds. An image
/// that states no errors counts as exact.
struct Comparison {
    int width = 0, height = 0;
    std::size_t pixels = 0;            ///< that count
    BoundedValue relative_rmse;        ///< sqrt(sum (L - L_ref)^2 / sum L_ref^2)
    double trimmed_relative_rmse = 0;  ///< the same without the worst 0.1 % of the pixels
    /// The same with the noise variance of both images subtracted, 0 where noise explains all of
    /// it.
    std::optional<double> noise_free_relative_rmse;
    BoundedValue ratio_of_means;  ///< image / reference
    WorstTile worst_tile;
    /// Where both images state the errors of their tiles and all pixels count.
    std::optional<TileAgreement> tile_agreement;
};

/// Compares pixel by pixel. @param scale luminance of the image that stands for 1 in the reference.
/// @param mask of the same size: pixels of value 0 do not count.
/// Throws InputError where sizes differ, no pixel counts, or the reference is black.
Comparison compare_images(const LuminanceImage& reference, const LuminanceImage& image,
                          double scale = 1.0, const LuminanceImage* mask = nullptr);

std::string comparison_text(const Comparison& comparison);

}  // namespace lucerna::io
