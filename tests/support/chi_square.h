// Pearson's chi-square of sampled counts against counts expected from a density (rules S3 and S4 of
// the style guide).
#pragma once

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <string>
#include <vector>

namespace lucerna::test {

/// A chi-square deviate beyond this has a chance of 1e-6 if the sampler is right.
inline constexpr double chi_square_limit = 4.753;

struct Cell {
    double counted, expected, other;  ///< `other`: expected from a second density
};

/// Cells merged to at least 5 expected samples, those with the least first: so a sample where none
/// is expected stays in a small cell and counts fully.
inline std::vector<Cell> merged_cells(const std::vector<double>& counts,
                                      const std::vector<double>& expected,
                                      const std::vector<double>& other) {
    std::vector<std::size_t> order(expected.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return expected[a] < expected[b]; });
    std::vector<Cell> cells;
    Cell sum{0.0, 0.0, 0.0};
    for (const std::size_t i : order) {
        sum.counted += counts[i];
        sum.expected += expected[i];
        sum.other += other[i];
        if (sum.expected < 5.0) continue;
        cells.push_back(sum);
        sum = {0.0, 0.0, 0.0};
    }
    return cells;
}

/// Standard normal deviate of a chi-square (Wilson and Hilferty, 1931), and its inverse.
inline double deviate_of(double chi_square, double degrees) {
    const double spread = 2.0 / (9.0 * degrees);
    return (std::cbrt(chi_square / degrees) - (1.0 - spread)) / std::sqrt(spread);
}
inline double chi_square_of(double deviate, double degrees) {
    const double spread = 2.0 / (9.0 * degrees);
    return degrees * std::pow(1.0 - spread + deviate * std::sqrt(spread), 3);
}

/// Chi-square of counts as a standard normal deviate: about 0 +/- 1 if they follow the expectation.
inline double chi_square_deviate(const std::vector<double>& counts,
                                 const std::vector<double>& expected) {
    const std::vector<Cell> cells = merged_cells(counts, expected, expected);
    double chi_square = 0.0;
    for (const Cell& cell : cells) {
        chi_square += std::pow(cell.counted - cell.expected, 2) / cell.expected;
    }
    return deviate_of(chi_square, static_cast<double>(cells.size()) - 1.0);
}

/// The cells that add most to the chi-square.
inline std::string worst_cells(const std::vector<double>& counts,
                               const std::vector<double>& expected) {
    std::vector<std::size_t> order(expected.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto share = [&](std::size_t i) {
        return std::pow(counts[i] - expected[i], 2) / std::max(expected[i], 1.0);
    };
    const auto shown = static_cast<std::ptrdiff_t>(std::min<std::size_t>(4, order.size()));
    std::partial_sort(order.begin(), order.begin() + shown, order.end(),
                      [&](std::size_t a, std::size_t b) { return share(a) > share(b); });
    std::string text = "worst cells:";
    for (auto i = order.begin(); i != order.begin() + shown; ++i) {
        text += " [" + std::to_string(*i) + "] " + std::to_string(counts[*i]) + " for " +
                std::to_string(expected[*i]);
    }
    return text;
}

/// Fails if the counts do not follow the expectation, at a level of 1e-6.
inline void check_follows(const std::vector<double>& counts, const std::vector<double>& expected) {
    INFO(worst_cells(counts, expected));
    CHECK(chi_square_deviate(counts, expected) < chi_square_limit);
}

/// The twin: the counts must refute the expectation of a wrong density, and not by luck: a sampler
/// with the density of `expected` refutes it in 99.9 % of all runs.
inline void check_refutes(const std::vector<double>& counts, const std::vector<double>& expected,
                          const std::vector<double>& wrong) {
    const std::vector<Cell> cells = merged_cells(counts, wrong, expected);
    const double degrees = static_cast<double>(cells.size()) - 1.0;
    double excess = 0.0;  // the parameter of the non-central chi-square
    for (const Cell& cell : cells) {
        excess += std::pow(cell.other - cell.expected, 2) / cell.expected;
    }
    const double unlucky = degrees + excess - 3.09 * std::sqrt(2.0 * (degrees + 2.0 * excess));
    CHECK(unlucky > chi_square_of(chi_square_limit, degrees));
    CHECK(chi_square_deviate(counts, wrong) > chi_square_limit);
}

}  // namespace lucerna::test
