#include "io/compare.h"

#include <algorithm>
#include <cmath>

#include "core/diagnostics.h"

namespace lucerna::io {
namespace {

constexpr int tile_size = 16;
constexpr double coverage_factor = 1.959963984540054;  // normal distribution, 95 % two-sided

// The pixels of both images on one scale.
class PixelPairs {
public:
    PixelPairs(const LuminanceImage& reference, const LuminanceImage& image, double scale,
               const LuminanceImage* mask)
        : reference_(reference), image_(image), scale_(scale), mask_(mask) {}

    bool counts(std::size_t i) const { return mask_ == nullptr || mask_->luminance[i] != 0.0; }
    double reference(std::size_t i) const { return reference_.luminance[i]; }
    double image(std::size_t i) const { return image_.luminance[i] / scale_; }
    double difference(std::size_t i) const { return image(i) - reference(i); }
    /// Standard errors; 0 for an image that states none, which then counts as exact.
    double reference_error(std::size_t i) const {
        return reference_.standard_error.empty() ? 0.0 : reference_.standard_error[i];
    }
    double image_error(std::size_t i) const {
        return image_.standard_error.empty() ? 0.0 : image_.standard_error[i] / scale_;
    }
    double error(std::size_t i) const { return std::hypot(reference_error(i), image_error(i)); }
    bool has_errors() const {
        return !reference_.standard_error.empty() || !image_.standard_error.empty();
    }
    std::size_t size() const { return reference_.luminance.size(); }
    int width() const { return reference_.width; }
    int height() const { return reference_.height; }

private:
    const LuminanceImage& reference_;
    const LuminanceImage& image_;
    double scale_;
    const LuminanceImage* mask_;
};

void check(const LuminanceImage& reference, const LuminanceImage& image,
           const LuminanceImage* mask) {
    const auto check_size = [&](const LuminanceImage& other, const char* name) {
        if (other.width == reference.width && other.height == reference.height) return;
        throw std::invalid_argument(
            fmt::format("the {} has {} x {} pixels and the reference {} x {}; expected "
                        "the same size",
                        name, other.width, other.height, reference.width, reference.height));
    };
    check_size(image, "image");
    if (mask != nullptr) check_size(*mask, "mask");
}

struct Sums {
    double reference = 0.0, image = 0.0, reference_squared = 0.0;
    double squared_difference = 0.0, error_variance = 0.0, squared_difference_variance = 0.0;
    double reference_variance = 0.0, image_variance = 0.0;  // of the sums, pixels independent
    double reference_error = 0.0, image_error = 0.0;        // of the sums, pixels fully correlated
    std::vector<double> squared_differences;
};

Sums sum(const PixelPairs& pairs) {
    Sums sums;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        if (!pairs.counts(i)) continue;
        const double d2 = std::pow(pairs.difference(i), 2);
        const double s2 = std::pow(pairs.error(i), 2);
        sums.reference += pairs.reference(i);
        sums.image += pairs.image(i);
        sums.reference_squared += std::pow(pairs.reference(i), 2);
        sums.squared_difference += d2;
        sums.error_variance += s2;
        // Variance of (delta + e)^2 with e normal of deviation s: 2 s^4 + 4 delta^2 s^2, and d^2 -
        // s^2 estimates delta^2.
        sums.squared_difference_variance += 2.0 * s2 * s2 + 4.0 * std::max(0.0, d2 - s2) * s2;
        sums.reference_variance += std::pow(pairs.reference_error(i), 2);
        sums.image_variance += std::pow(pairs.image_error(i), 2);
        sums.reference_error += pairs.reference_error(i);
        sums.image_error += pairs.image_error(i);
        sums.squared_differences.push_back(d2);
    }
    return sums;
}

// Square root of the sum without the largest 0.1 % of the terms, at least one.
double trimmed_root(std::vector<double> squares) {
    const auto worst =
        std::max<std::ptrdiff_t>(1, std::lround(0.001 * static_cast<double>(squares.size())));
    std::nth_element(squares.begin(), squares.end() - worst, squares.end());
    double total = 0.0;
    for (auto it = squares.begin(); it != squares.end() - worst; ++it) total += *it;
    return std::sqrt(total);
}

WorstTile worst_tile(const PixelPairs& pairs, double mean_reference) {
    WorstTile worst;
    double largest = -1.0;
    for (int top = 0; top < pairs.height(); top += tile_size) {
        for (int left = 0; left < pairs.width(); left += tile_size) {
            double reference = 0.0, image = 0.0, error = 0.0, count = 0.0;
            for (int y = top; y < std::min(top + tile_size, pairs.height()); ++y) {
                for (int x = left; x < std::min(left + tile_size, pairs.width()); ++x) {
                    const auto i =
                        static_cast<std::size_t>(y) * static_cast<std::size_t>(pairs.width()) +
                        static_cast<std::size_t>(x);
                    if (!pairs.counts(i)) continue;
                    reference += pairs.reference(i);
                    image += pairs.image(i);
                    error += pairs.error(i);
                    count += 1.0;
                }
            }
            if (count == 0.0 || !(std::abs(image - reference) / count > largest)) continue;
            largest = std::abs(image - reference) / count;
            worst = {left, top, reference / count, image / count, {}};
            worst.difference.value = (image - reference) / count / mean_reference;
            if (pairs.has_errors()) {
                worst.difference.expanded_uncertainty =
                    coverage_factor * error / count / mean_reference;
            }
        }
    }
    return worst;
}

std::string percent(const BoundedValue& bounded) {
    if (!bounded.expanded_uncertainty) return fmt::format("{:.3f} %", 100.0 * bounded.value);
    return fmt::format("{:.3f} % ± {:.2g} %", 100.0 * bounded.value,
                       100.0 * *bounded.expanded_uncertainty);
}

}  // namespace

Comparison compare_images(const LuminanceImage& reference, const LuminanceImage& image,
                          double scale, const LuminanceImage* mask) {
    check(reference, image, mask);
    const PixelPairs pairs(reference, image, scale, mask);
    const Sums sums = sum(pairs);
    if (sums.squared_differences.empty())
        throw InputError({}, "the mask leaves no pixel to compare");
    if (!(sums.reference > 0.0)) throw InputError({}, "the reference is black");

    Comparison result;
    result.width = reference.width;
    result.height = reference.height;
    result.pixels = sums.squared_differences.size();
    result.relative_rmse.value = std::sqrt(sums.squared_difference / sums.reference_squared);
    result.trimmed_relative_rmse =
        trimmed_root(sums.squared_differences) / std::sqrt(sums.reference_squared);
    const double ratio = sums.image / sums.reference;
    result.ratio_of_means.value = ratio;
    if (pairs.has_errors()) {
        result.noise_free_relative_rmse = std::sqrt(
            std::max(0.0, sums.squared_difference - sums.error_variance) / sums.reference_squared);
        // d sqrt(D / N) = d D / (2 sqrt(D N))
        result.relative_rmse.expanded_uncertainty =
            sums.squared_difference > 0.0
                ? coverage_factor * std::sqrt(sums.squared_difference_variance) /
                      (2.0 * std::sqrt(sums.squared_difference * sums.reference_squared))
                : 0.0;
        result.ratio_of_means.expanded_uncertainty =
            coverage_factor *
            std::sqrt(sums.image_variance + ratio * ratio * sums.reference_variance) /
            sums.reference;
        result.ratio_correlated_uncertainty =
            coverage_factor * std::hypot(sums.image_error, ratio * sums.reference_error) /
            sums.reference;
    }
    result.worst_tile = worst_tile(pairs, sums.reference / static_cast<double>(result.pixels));
    return result;
}

std::string comparison_text(const Comparison& comparison) {
    std::string text = fmt::format("{} x {} pixels, {} compared\n", comparison.width,
                                   comparison.height, comparison.pixels);
    text += fmt::format("relative RMSE                 {}\n", percent(comparison.relative_rmse));
    text += fmt::format("  without the worst 0.1 %     {:.3f} %\n",
                        100.0 * comparison.trimmed_relative_rmse);
    if (comparison.noise_free_relative_rmse) {
        text += fmt::format("  noise variance subtracted   {:.3f} %\n",
                            100.0 * *comparison.noise_free_relative_rmse);
    }
    text += fmt::format("ratio of means                {:.5f}", comparison.ratio_of_means.value);
    if (comparison.ratio_of_means.expanded_uncertainty) {
        text += fmt::format(" ± {:.2g} (pixels independent) ± {:.2g} (fully correlated)",
                            *comparison.ratio_of_means.expanded_uncertainty,
                            *comparison.ratio_correlated_uncertainty);
    }
    const WorstTile& tile = comparison.worst_tile;
    text += fmt::format(
        "\nworst {0} x {0} tile            at [{1}, {2}]: mean {3:.5g}, reference {4:.5g}, "
        "difference "
        "{5} of the reference's mean\n",
        tile_size, tile.x, tile.y, tile.image_mean, tile.reference_mean, percent(tile.difference));
    if (!comparison.ratio_of_means.expanded_uncertainty) {
        text += "Neither image states standard errors, so there are no bounds.\n";
    }
    return text;
}

}  // namespace lucerna::io
