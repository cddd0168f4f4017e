// What a simulation says about one number. The only file that knows how results state their error.
#pragma once

#include <functional>
#include <limits>

#include "optics/transport/result.h"

namespace lucerna::validation {

struct Reading {
    double value = 0.0;
    double standard_error = 0.0;        ///< of the value over phases
    double expanded_uncertainty = 0.0;  ///< U at 95 %, all known errors included
    /// Degrees of freedom of both.
    double degrees_of_freedom = std::numeric_limits<double>::infinity();
    double uncorrected_value = 0.0;           ///< mean over phases without bias correction
    double uncorrected_standard_error = 0.0;  ///< of that mean (docs/method.md eq. 5)
};

/// Takes a number from a result.
using Read = std::function<Reading(const optics::Result&)>;

/// Of the i-th of Result::quantities: observers in their order, then front and back of each
/// receiver.
Read sensor(std::size_t i);
/// Of the i-th of Result::derived: of each sensor of several points mean, minimum, maximum,
/// uniformity U0 and diversity Ud.
Read derived(std::size_t i);
/// Of the i-th of Result::images: its mean luminance.
Read image_mean(std::size_t i);
/// Of the i-th of Result::images: the luminance of a pixel, row by row from the top left.
Read pixel(std::size_t i, std::size_t index);
/// Chromaticity of CIE 1931 and correlated colour temperature [K] of the i-th of
/// Result::quantities.
Read chromaticity_x(std::size_t i);
Read chromaticity_y(std::size_t i);
Read colour_temperature_k(std::size_t i);
/// A reading times a constant.
Read scaled(Read read, double factor);

}  // namespace lucerna::validation
