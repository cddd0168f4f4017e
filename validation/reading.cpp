#include "validation/reading.h"

#include <cmath>

namespace lucerna::validation {
namespace {

Reading reading(const Estimate& estimate) {
    return {.value = estimate.value(),
            .standard_error = estimate.standard_error(),
            .expanded_uncertainty = estimate.expanded_uncertainty(),
            .degrees_of_freedom = estimate.degrees_of_freedom(),
            .uncorrected_value = estimate.mean(),
            .uncorrected_standard_error = estimate.mean_standard_error()};
}

Reading reading(const Uncertain& result) {
    return {.value = result.value,
            .standard_error = result.standard_error,
            .expanded_uncertainty = result.expanded_uncertainty(),
            .degrees_of_freedom = result.degrees_of_freedom,
            .uncorrected_value = result.value,
            .uncorrected_standard_error = result.standard_error};
}

const optics::Colour& colour(const optics::Result& result, std::size_t i) {
    return result.quantities.at(i).colour.value();
}

}  // namespace

Read chromaticity_x(std::size_t i) {
    return [i](const optics::Result& result) { return reading(colour(result, i).x); };
}

Read chromaticity_y(std::size_t i) {
    return [i](const optics::Result& result) { return reading(colour(result, i).y); };
}

Read colour_temperature_k(std::size_t i) {
    return [i](const optics::Result& result) { return reading(colour(result, i).cct_k.value()); };
}

Read sensor(std::size_t i) {
    return [i](const optics::Result& result) {
        const optics::Quantity& quantity = result.quantities.at(i);
        Reading r = reading(quantity.result());
        r.uncorrected_value = quantity.estimate.mean();
        r.uncorrected_standard_error = quantity.estimate.mean_standard_error();
        return r;
    };
}

Read derived(std::size_t i) {
    return [i](const optics::Result& result) { return reading(result.derived.at(i).result); };
}

Read image_mean(std::size_t i) {
    return [i](const optics::Result& result) { return reading(result.images.at(i).mean); };
}

Read pixel(std::size_t i, std::size_t index) {
    return [i, index](const optics::Result& result) {
        const optics::Image& image = result.images.at(i);
        Reading r = reading(image.pixel(index));
        const Estimate& estimate = image.luminance.at(index);
        r.uncorrected_value = estimate.mean();
        r.uncorrected_standard_error = estimate.mean_standard_error();
        return r;
    };
}

Read scaled(Read read, double factor) {
    return [read = std::move(read), factor](const optics::Result& result) {
        Reading r = read(result);
        r.value *= factor;
        r.standard_error *= std::abs(factor);
        r.expanded_uncertainty *= std::abs(factor);
        r.uncorrected_value *= factor;
        r.uncorrected_standard_error *= std::abs(factor);
        return r;
    };
}

}  // namespace lucerna::validation
