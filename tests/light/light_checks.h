// Shared by the tests of lights: random numbers, means, and the chi-square statistic.
#pragma once

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <vector>

#include "core/random.h"
#include "core/vector.h"
#include "tests/support/check_mean.h"

namespace lucerna::test {

/// Four uniform numbers of one sample.
inline std::array<double, 4> uniforms(std::uint32_t sample, std::uint64_t seed = 1) {
    RandomStream random(seed, 0, RandomPurpose::test, sample);
    return {random.uniform(), random.uniform(), random.uniform(), random.uniform()};
}

struct Mean {
    double value, standard_error;
};

/// Mean of f(u) over n samples.
inline Mean mean_of(std::uint32_t n, const std::function<double(const std::array<double, 4>&)>& f) {
    double sum = 0.0;
    double squares = 0.0;
    for (std::uint32_t i = 0; i < n; ++i) {
        const double value = f(uniforms(i));
        sum += value;
        squares += value * value;
    }
    const double mean = sum / n;
    return {mean, std::sqrt(std::max(0.0, squares / n - mean * mean) / (n - 1))};
}

/// Chi-square of counts against expected counts, as a standard normal deviate
/// (Wilson and Hilferty, 1931); cells below 5 expected counts are merged.
inline double chi_square_deviate(const std::vector<double>& counts,
                                 const std::vector<double>& expected) {
    double chi2 = 0.0;
    double degrees = -1.0;
    double count = 0.0;
    double mean = 0.0;
    for (std::size_t i = 0; i < counts.size(); ++i) {
        count += counts[i];
        mean += expected[i];
        if (mean < 5.0) continue;
        chi2 += (count - mean) * (count - mean) / mean;
        degrees += 1.0;
        count = mean = 0.0;
    }
    const double spread = 2.0 / (9.0 * degrees);
    return (std::cbrt(chi2 / degrees) - (1.0 - spread)) / std::sqrt(spread);
}

}  // namespace lucerna::test
