#include "io/compare.h"

#include <algorithm>
#include <cmath>

#include "core/diagnostics.h"
#include "core/statistics.h"
#include "optics/transport/result.h"

namespace lucerna::io {
namespace {

constexpr int tile_size = optics::Image::tile_size;
constexpr double coverage = 0.95;

// Half width of an interval in standard errors; of the normal distribution where the number of
// phases is unknown.
double coverage_factor(const LuminanceImage& image) {
    return image.phases >= 2 ? student_t(coverage, image.phases - 1.0) : student_t(coverage, 1e6);
}

// One of the two images on the scale of the reference.
class Picture {
public:
    Picture(const LuminanceImage& image, double scale)
        : image_(image), scale_(scale), factor_(coverage_factor(image) / scale) {}

    double luminance(std::size_t pixel) const { return image_.luminance[pixel] / scale_; }
    bool has_errors() const { return !image_.standard_error.empty(); }
    double variance(std::size_t pixel) const {
        return has_errors() ? std::pow(image_.standard_error[pixel] / scale_, 2) : 0.0;
    }
    /// Half width of the interval of a pixel.
    double bound(std::size_t pixel) const {
        return has_errors() ? factor_ * image_.standard_error[pixel] : 0.0;
    }
    /// The same of a tile's mean and of the image's mean, where the file states them.
    std::optional<double> tile_bound(std::size_t tile) const {
        if (!has_errors()) return 0.0;
        if (image_.tile_standard_error.empty()) return std::nullopt;
        return factor_ * image_.tile_standard_error[tile];
    }
    std::optional<double> tile_standard_error(std::size_t tile) const {
        if (image_.tile_standard_error.empty()) return std::nullopt;
        return image_.tile_standard_error[tile] / scale_;
    }
    std::optional<double> mean_bound() const {
        if (!has_errors()) return 0.0;
        if (!image_.mean_standard_error) return std::nullopt;
        return factor_ * *image_.mean_standard_error;
    }

private:
    const LuminanceImage& image_;
    double scale_;
    double factor_;
};

// Means over a set of pixels of both images.
struct Means {
    std::size_t count = 0;
    double reference = 0.0, image = 0.0;
    double reference_bound = 0.0, image_bound = 0.0;  // for any correlation of the pixels

    void add(const Picture& reference_side, const Picture& image_side, std::size_t pixel) {
        ++count;
        reference += reference_side.luminance(pixel);
        image += image_side.luminance(pixel);
        reference_bound += reference_side.bound(pixel);
        image_bound += image_side.bound(pixel);
    }
    void finish() {
        for (double* sum : {&reference, &image, &reference_bound, &image_bound}) {
            *sum /= static_cast<double>(count);
        }
    }
};

class Comparer {
public:
    Comparer(const LuminanceImage& reference, const LuminanceImage& image, double scale,
             const LuminanceImage* mask)
        : width_(reference.width),
          height_(reference.height),
          reference_(reference, 1.0),
          image_(image, scale),
          mask_(mask) {}

    Comparison compare() const {
        Comparison result;
        result.width = width_;
        result.height = height_;
        const Means means = means_of(0, 0, width_, height_);
        if (means.count == 0) throw InputError({}, "the mask leaves no pixel to compare");
        if (!(means.reference > 0.0)) throw InputError({}, "the reference is black");
        result.pixels = means.count;
        compare_pixels(result);

        const double ratio = means.image / means.reference;
        result.ratio_of_means.value = ratio;
        if (has_errors()) {
            const double image_bound = stated_or(image_.mean_bound(), means.image_bound);
            const double reference_bound =
                stated_or(reference_.mean_bound(), means.reference_bound);
            result.ratio_of_means.expanded_uncertainty =
                std::hypot(image_bound, ratio * reference_bound) / means.reference;
        }
        result.worst_tile = worst_tile(means.reference);
        if (mask_ == nullptr) result.tile_agreement = tile_agreement();
        return result;
    }

private:
    bool has_errors() const { return reference_.has_errors() || image_.has_errors(); }
    bool counts(std::size_t pixel) const {
        return mask_ == nullptr || mask_->luminance[pixel] != 0.0;
    }
    // A file states the errors of means over all pixels only.
    double stated_or(std::optional<double> stated, double bound) const {
        return mask_ == nullptr && stated ? *stated : bound;
    }

    Means means_of(int left, int top, int right, int bottom) const {
        Means means;
        for (int y = top; y < bottom; ++y) {
            for (int x = left; x < right; ++x) {
                const auto pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                                   static_cast<std::size_t>(x);
                if (counts(pixel)) means.add(reference_, image_, pixel);
            }
        }
        means.finish();
        return means;
    }

    void compare_pixels(Comparison& result) const {
        std::vector<double> squares;
        double norm = 0.0, total = 0.0, noise = 0.0, variance_of_total = 0.0;
        const std::size_t pixels =
            static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
        for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
            if (!counts(pixel)) continue;
            const double d2 = std::pow(image_.luminance(pixel) - reference_.luminance(pixel), 2);
            const double s2 = reference_.variance(pixel) + image_.variance(pixel);
            norm += std::pow(reference_.luminance(pixel), 2);
            total += d2;
            noise += s2;
            // Variance of (delta + e)^2 with e normal of deviation s is 2 s^4 + 4 delta^2 s^2; d^2
            // - s^2 estimates delta^2.
            variance_of_total += 2.0 * s2 * s2 + 4.0 * std::max(0.0, d2 - s2) * s2;
            squares.push_back(d2);
        }
        result.relative_rmse.value = std::sqrt(total / norm);
        result.trimmed_relative_rmse = std::sqrt(trimmed_sum(std::move(squares)) / norm);
        if (!has_errors()) return;
        result.noise_free_relative_rmse = std::sqrt(std::max(0.0, total - noise) / norm);
        // d sqrt(T / N) = dT / (2 sqrt(T N))
        result.relative_rmse.expanded_uncertainty =
            total > 0.0 ? student_t(coverage, 1e6) * std::sqrt(variance_of_total) /
                              (2.0 * std::sqrt(total * norm))
                        : 0.0;
    }

    // Without the largest 0.1 % of the terms, at least one.
    static double trimmed_sum(std::vector<double> terms) {
        const auto worst = std::max(1L, std::lround(0.001 * static_cast<double>(terms.size())));
        std::nth_element(terms.begin(), terms.end() - worst, terms.end());
        double sum = 0.0;
        for (auto term = terms.begin(); term != terms.end() - worst; ++term) sum += *term;
        return sum;
    }

    WorstTile worst_tile(double mean_reference) const {
        WorstTile worst;
        double largest = -1.0;
        std::size_t tile = 0;
        for (int top = 0; top < height_; top += tile_size) {
            for (int left = 0; left < width_; left += tile_size, ++tile) {
                const Means means = means_of(left, top, std::min(left + tile_size, width_),
                                             std::min(top + tile_size, height_));
                const double difference = means.image - means.reference;
                if (means.count == 0 || !(std::abs(difference) > largest)) continue;
                largest = std::abs(difference);
                worst = {left,
                         top,
                         means.reference,
                         means.image,
                         {difference / mean_reference, std::nullopt}};
                if (has_errors()) {
                    worst.difference.expanded_uncertainty =
                        std::hypot(stated_or(image_.tile_bound(tile), means.image_bound),
                                   stated_or(reference_.tile_bound(tile), means.reference_bound)) /
                        mean_reference;
                }
            }
        }
        return worst;
    }

    std::optional<TileAgreement> tile_agreement() const {
        TileAgreement agreement;
        std::vector<double> relative_errors;
        std::size_t tile = 0;
        for (int top = 0; top < height_; top += tile_size) {
            for (int left = 0; left < width_; left += tile_size, ++tile) {
                const auto image_error = image_.tile_standard_error(tile);
                const auto reference_error = reference_.tile_standard_error(tile);
                if (!image_error || !reference_error) return std::nullopt;
                const Means means = means_of(left, top, std::min(left + tile_size, width_),
                                             std::min(top + tile_size, height_));
                const double error = std::hypot(*image_error, *reference_error);
                if (!(error > 0.0) || !(means.reference > 0.0)) continue;
                relative_errors.push_back(error / means.reference);
                const double deviation = std::abs(means.image - means.reference) / error;
                if (deviation > agreement.largest_deviation) {
                    agreement.largest_deviation = deviation;
                    agreement.x = left;
                    agreement.y = top;
                }
            }
        }
        if (relative_errors.empty()) return std::nullopt;
        const auto middle = relative_errors.begin() + static_cast<long>(relative_errors.size() / 2);
        std::nth_element(relative_errors.begin(), middle, relative_errors.end());
        agreement.median_relative_error = *middle;
        return agreement;
    }

    int width_, height_;
    Picture reference_, image_;
    const LuminanceImage* mask_;
};

std::string percent(const BoundedValue& bounded) {
    std::string text = fmt::format("{:.3f} %", 100.0 * bounded.value);
    if (bounded.expanded_uncertainty)
        text += fmt::format(" ± {:.2g} %", 100.0 * *bounded.expanded_uncertainty);
    return text;
}

}  // namespace

Comparison compare_images(const LuminanceImage& reference, const LuminanceImage& image,
                          double scale, const LuminanceImage* mask) {
    const auto check_size = [&](const LuminanceImage& other, const char* name) {
        if (other.width == reference.width && other.height == reference.height) return;
        throw InputError(
            {}, fmt::format(
                    "the {} has {} x {} pixels and the reference {} x {}; expected the same size",
                    name, other.width, other.height, reference.width, reference.height));
    };
    check_size(image, "image");
    if (mask != nullptr) check_size(*mask, "mask");
    return Comparer(reference, image, scale, mask).compare();
}

std::string comparison_text(const Comparison& comparison) {
    std::string text = fmt::format("{} x {} pixels, {} compared\n", comparison.width,
                                   comparison.height, comparison.pixels);
    text += fmt::format("relative RMSE                {}\n", percent(comparison.relative_rmse));
    text += fmt::format("  without the worst 0.1 %    {:.3f} %\n",
                        100.0 * comparison.trimmed_relative_rmse);
    if (comparison.noise_free_relative_rmse) {
        text += fmt::format("  noise variance subtracted  {:.3f} %\n",
                            100.0 * *comparison.noise_free_relative_rmse);
    }
    text += fmt::format("ratio of means               {:.5f}", comparison.ratio_of_means.value);
    if (comparison.ratio_of_means.expanded_uncertainty) {
        text += fmt::format(" ± {:.2g}", *comparison.ratio_of_means.expanded_uncertainty);
    }
    const WorstTile& tile = comparison.worst_tile;
    text += fmt::format(
        "\nworst {0} x {0} tile           at [{1}, {2}]: mean {3:.5g}, reference {4:.5g}; "
        "difference {5} "
        "of the reference's mean\n",
        tile_size, tile.x, tile.y, tile.image_mean, tile.reference_mean, percent(tile.difference));
    if (const auto& agreement = comparison.tile_agreement) {
        text += fmt::format(
            "tiles agree within           {:.2f} standard errors, the largest at [{}, {}]; median "
            "standard error {:.2g} %\n",
            agreement->largest_deviation, agreement->x, agreement->y,
            100.0 * agreement->median_relative_error);
    }
    text += comparison.ratio_of_means.expanded_uncertainty
                ? "± is the noise of both images, 95 %\n"
                : "Neither image states its errors, so there are no bounds.\n";
    return text;
}

}  // namespace lucerna::io
