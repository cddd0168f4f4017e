// Statistical checks with known level and power (rules S1 to S3 of the style guide).
#pragma once

#include <catch2/catch.hpp>
#include <cmath>

namespace lucerna::test {

/// Two-sided level of 1e-6: a correct program fails one such check in a million changes.
inline constexpr double level_1e6 = 4.892;
/// Distance at which an error is found with a probability of 99.9 %: 4.892 + 3.090.
inline constexpr double power_999 = 7.982;

/// Smallest relative error that a check finds with a probability of 99.9 %.
struct DetectsRelative {
    double fraction;
};

/// True if the estimate agrees with the truth; `bias_bound` is a stated bound that adds to the
/// noise.
inline bool agrees(double value, double standard_error, double truth, double bias_bound = 0.0) {
    return std::abs(value - truth) <= level_1e6 * standard_error + bias_bound;
}

/// Fails if the check is too weak to find the stated error, and if the estimate disagrees.
inline void check_mean(double value, double standard_error, double truth, DetectsRelative detects,
                       double bias_bound = 0.0) {
    INFO("value " << value << " +/- " << standard_error << ", truth " << truth
                  << ", z = " << (value - truth) / standard_error << ", bias bound " << bias_bound);
    CHECK(power_999 * standard_error + bias_bound <= detects.fraction * std::abs(truth));
    CHECK(agrees(value, standard_error, truth, bias_bound));
}

}  // namespace lucerna::test
