#include "io/preview.h"

#include <algorithm>
#include <cmath>

#include "io/colour_map.h"
#include "io/display_encoding.h"
#include "io/legend.h"

namespace lucerna::io {
namespace {

// Sorted luminances > 0; one of 1 cd/m2 for an image without any light.
std::vector<double> sorted_luminances(const optics::Image& image) {
    std::vector<double> luminances;
    for (std::size_t i = 0; i < image.luminance.size(); ++i) {
        const double luminance = image.luminance[i].value(image.corrected_share(i));
        if (luminance > 0.0 && std::isfinite(luminance)) luminances.push_back(luminance);
    }
    if (luminances.empty()) return {1.0};
    std::sort(luminances.begin(), luminances.end());
    return luminances;
}

double percentile(const std::vector<double>& sorted, double share) {
    return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))];
}

// The nearest of 1, 2 or 5 times a power of ten that is not above the value.
double round_down(double value) {
    return log_ticks(value / 10.0, value).back();
}
double round_up(double value) {
    return log_ticks(value, value * 10.0).front();
}

std::array<float, 3> to_float(const Vec3& v) {
    return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

}  // namespace

NaturalPreview natural_preview(const optics::Image& image) {
    const double white = percentile(sorted_luminances(image), exposure_percentile) / exposure_level;
    std::vector<std::array<float, 3>> xyz(image.luminance.size());
    for (std::size_t i = 0; i < xyz.size(); ++i) {
        xyz[i] =
            to_float(Vec3(double{image.x[i]}, image.luminance[i].value(image.corrected_share(i)),
                          double{image.z[i]}) /
                     white);
    }
    NaturalPreview preview{Raster(image.width, image.height, {}), white};
    preview.raster.pixels = encode_for_display(std::move(xyz));
    return preview;
}

FalseColourPreview false_colour_preview(const optics::Image& image) {
    constexpr double most_decades = 3.0;
    const std::vector<double> sorted = sorted_luminances(image);
    const double max = round_up(percentile(sorted, 0.99));
    const double lowest = std::max(percentile(sorted, 0.01), max * std::pow(10.0, -most_decades));
    const double min = std::min(round_down(lowest), max / 10.0);  // at least one decade

    constexpr int colours = 1024;
    std::vector<std::array<float, 3>> map(colours);
    for (int i = 0; i < colours; ++i) map[i] = to_float(false_colour_xyz(i / (colours - 1.0)));
    const std::vector<Rgb8> display = encode_for_display(std::move(map));
    const auto colour_of = [&](double position) {  // below the scale: its lowest colour
        return display[static_cast<std::size_t>(
            std::lround(std::clamp(position, 0.0, 1.0) * (colours - 1)))];
    };

    const int block = std::max(1, image.height / 360);  // of the legend's letters
    constexpr int lowest_legend = 120;
    FalseColourPreview preview{
        Raster(image.width + legend_width(block), std::max(image.height, lowest_legend), {}), min,
        max};
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            const auto i = static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                           static_cast<std::size_t>(x);
            const double luminance = image.luminance[i].value(image.corrected_share(i));
            const double position =
                luminance > 0.0 ? std::log(luminance / min) / std::log(max / min) : 0.0;
            preview.raster.at(x, y) = colour_of(position);
        }
    }
    draw_legend(preview.raster, image.width, block, min, max, colour_of);
    return preview;
}

}  // namespace lucerna::io
