// Figures of grids against those of their points.
#include <catch2/catch.hpp>

#include "optics/transport/grid_figures.h"

using namespace lucerna;
using namespace lucerna::optics;
using Catch::Matchers::WithinRel;

TEST_CASE("What is left of the biases of points enters the figures of their grid", "[unit]") {
    // Three points in X, Y, Z, and the emission, which is as known. The noise is the same factor
    // for all points, so that ratios have none.
    const std::vector<double> y{20.0, 10.0, 40.0}, bias_left{0.3, 0.2, 0.5};
    const Vec3 emission(1.0, 1.0, 1.0);
    BatchMeans sums(3 * y.size() + 3);
    for (int phase = 0; phase < 6; ++phase) {
        const double factor = phase % 2 == 0 ? 1.1 : 0.9;
        std::vector<double> values;
        for (const double own : y) values.insert(values.end(), {0.0, factor * own, 0.0});
        values.insert(values.end(), {1.0, 1.0, 1.0});
        sums.add(values);
    }
    const Calibration calibration(sums, emission);
    const GridFigures grid(calibration, 0, bias_left);

    const double mean = 70.0 / 3.0, of_mean = std::sqrt(0.09 + 0.04 + 0.25) / 3.0;
    struct Row {
        const char* name;
        Uncertain figure;
        double value, bias_left, relative_noise;
    };
    const double noise = 0.1 / std::sqrt(5.0);
    for (const Row& row : {Row{"mean", grid.mean(), mean, of_mean, noise},
                           Row{"minimum", grid.minimum(), 10.0, 0.2, noise},
                           Row{"maximum", grid.maximum(), 40.0, 0.5, noise},
                           Row{"minimum / mean", grid.minimum_to_mean(), 10.0 / mean,
                               10.0 / mean * std::hypot(0.2 / 10.0, of_mean / mean), 0.0},
                           Row{"minimum / maximum", grid.minimum_to_maximum(), 0.25,
                               0.25 * std::hypot(0.2 / 10.0, 0.5 / 40.0), 0.0}}) {
        INFO(row.name);
        CHECK_THAT(row.figure.value, WithinRel(row.value, 1e-12));
        CHECK_THAT(row.figure.bias_left, WithinRel(row.bias_left, 1e-12));
        CHECK(std::abs(row.figure.standard_error - row.relative_noise * row.value) < 1e-9);
        CHECK(row.figure.candidates == 1.0);
    }
}

TEST_CASE("Each extreme of a grid counts those that it might have been mistaken for", "[unit]") {
    // Two points are darkest alike but for noise of their own, and three brightest.
    const std::vector<double> y{10.0, 10.0, 20.0, 40.0, 40.0, 40.0};
    BatchMeans sums(3 * y.size() + 3);
    for (int phase = 0; phase < 6; ++phase) {
        std::vector<double> values;
        for (std::size_t k = 0; k < y.size(); ++k) {
            const double own = 0.1 * std::sin(1.0 + 2.0 * phase + 5.0 * static_cast<double>(k));
            values.insert(values.end(), {0.0, y[k] * (1.0 + own), 0.0});
        }
        values.insert(values.end(), {1.0, 1.0, 1.0});
        sums.add(values);
    }
    const Vec3 emission(1.0, 1.0, 1.0);
    const Calibration calibration(sums, emission);
    const GridFigures grid(calibration, 0, std::vector<double>(y.size(), 0.0));
    CHECK(grid.mean().candidates == 1.0);
    CHECK(grid.minimum().candidates == 2.0);
    CHECK(grid.maximum().candidates == 3.0);
    CHECK(grid.minimum_to_mean().candidates == 2.0);
    CHECK(grid.minimum_to_maximum().candidates == 6.0);
}
