#include "core/stratified.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <set>
#include <vector>

using namespace lucerna;

namespace {

constexpr std::uint32_t count = 64;

// Pair number `dimension` of all paths of a set.
std::vector<std::array<double, 2>> pairs(std::uint32_t set, int dimension,
                                         std::uint32_t size = count) {
    std::vector<std::array<double, 2>> result;
    for (std::uint32_t i = 0; i < size; ++i) {
        StratifiedStream stream(RandomStream(1, set, RandomPurpose::test, i),
                                {RandomStream(1, set, RandomPurpose::strata, 0).bits(), i, size});
        std::array<double, 2> pair{};
        for (int d = 0; d <= dimension; ++d) pair = stream.pair();
        result.push_back(pair);
    }
    return result;
}

}  // namespace

TEST_CASE("Pairs of a set fill all elementary intervals", "[unit]") {
    for (const int dimension : {0, 1, 5}) {
        for (std::uint32_t columns = 1; columns <= count; columns *= 2) {
            const std::uint32_t rows = count / columns;
            std::set<std::uint32_t> cells;
            for (const auto& [u, v] : pairs(7, dimension)) {
                REQUIRE((u >= 0.0 && u < 1.0 && v >= 0.0 && v < 1.0));
                cells.insert(static_cast<std::uint32_t>(u * columns) * rows +
                             static_cast<std::uint32_t>(v * rows));
            }
            CHECK(cells.size() == count);  // one point in each of the 2^-k x 2^(k-6) cells
        }
    }
    // Twin: later pairs are random, and leave cells empty.
    std::set<std::uint32_t> cells;
    for (const auto& [u, v] : pairs(7, 20)) {
        cells.insert(static_cast<std::uint32_t>(u * 8) * 8 + static_cast<std::uint32_t>(v * 8));
    }
    CHECK(cells.size() < count);
}

TEST_CASE("Means over a set are unbiased and vary little from set to set", "[statistical]") {
    // Over 2000 sets: the mean of u v (1/4), with much less variance than random points have
    // (7/144 / count), and of a product of two different dimensions, for which the order must be
    // independent.
    constexpr int sets = 2000;
    double sum = 0.0, squares = 0.0, across = 0.0, across_squares = 0.0;
    for (std::uint32_t set = 0; set < sets; ++set) {
        const auto first = pairs(set, 0), second = pairs(set, 1);
        double mean = 0.0, product = 0.0;
        for (std::uint32_t i = 0; i < count; ++i) {
            mean += first[i][0] * first[i][1] / count;
            product += first[i][0] * second[i][0] / count;
        }
        sum += mean;
        squares += mean * mean;
        across += product;
        across_squares += product * product;
    }
    const auto standard_error = [](double s, double s2) {
        return std::sqrt(std::max(0.0, s2 / sets - s * s / sets / sets) / sets);
    };
    // 4.9 standard errors: a chance of 1e-6.
    CHECK(std::abs(sum / sets - 0.25) < 4.9 * standard_error(sum, squares));
    CHECK(std::abs(across / sets - 0.25) < 4.9 * standard_error(across, across_squares));
    const double random = std::sqrt(7.0 / 144.0 / count / sets);
    CHECK(standard_error(sum, squares) < 0.1 * random);
    CHECK(standard_error(across, across_squares) < random);
}
