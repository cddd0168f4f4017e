// Shared by the tests of lights: random numbers and means.
#pragma once

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <vector>

#include "core/random.h"
#include "core/vector.h"
#include "tests/support/check_mean.h"
#include "tests/support/chi_square.h"

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

}  // namespace lucerna::test
