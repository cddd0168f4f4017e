#include "core/statistics.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "core/random.h"
#include "core/vector.h"

using namespace lucerna;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

TEST_CASE("Quantiles of Student's t are those of the published tables", "[unit]") {
    // NIST/SEMATECH e-Handbook 1.3.6.7.2 and Fisher and Yates; two-sided coverage
    CHECK_THAT(student_t(0.95, 1.0), WithinRel(12.7062047, 1e-8));
    CHECK_THAT(student_t(0.95, 2.0), WithinRel(4.30265273, 1e-8));
    CHECK_THAT(student_t(0.95, 9.0), WithinRel(2.26215716, 1e-8));
    CHECK_THAT(student_t(0.95, 29.0), WithinRel(2.04522964, 1e-8));
    CHECK_THAT(student_t(0.99, 9.0), WithinRel(3.24983554, 1e-8));
    CHECK_THAT(student_t(0.90, 120.0), WithinRel(1.65765090, 1e-8));
    // many degrees: the normal distribution
    CHECK_THAT(student_t(0.95, 1e7), WithinRel(1.95996398, 1e-6));
}

TEST_CASE("Quantiles of Student's t agree with closed forms", "[property]") {
    const double coverage = GENERATE(0.5, 0.6827, 0.9, 0.95, 0.99, 0.9999);
    // one degree: Cauchy; two degrees: c sqrt(2 / (1 - c^2))
    CHECK_THAT(student_t(coverage, 1.0),
               WithinRel(std::tan(0.5 * std::acos(-1.0) * coverage), 1e-8));
    CHECK_THAT(student_t(coverage, 2.0),
               WithinRel(coverage * std::sqrt(2.0 / (1.0 - coverage * coverage)), 1e-8));
}

TEST_CASE("Mean, bias and their standard errors", "[unit]") {
    Estimate estimate;
    // 2, 4, 4, 4, 5, 5, 7, 9: mean 5, sum of squares 32, so that SE^2 = 32 / (8 * 7)
    for (const double value : {2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0}) {
        estimate.add(value, 0.1 * value);
    }
    CHECK(estimate.count() == 8);
    CHECK_THAT(estimate.mean(), WithinRel(5.0, 1e-15));
    CHECK_THAT(estimate.mean_standard_error(), WithinRel(std::sqrt(32.0 / 56.0), 1e-14));
    CHECK_THAT(estimate.bias(), WithinRel(0.5, 1e-14));
    CHECK_THAT(estimate.bias_standard_error(), WithinRel(0.1 * std::sqrt(32.0 / 56.0), 1e-12));
}

TEST_CASE("Too few phases have no error bar", "[unit]") {
    Estimate estimate;
    CHECK(estimate.count() == 0);
    CHECK(estimate.mean() == 0.0);
    CHECK(std::isinf(estimate.standard_error()));
    estimate.add(3.0);
    CHECK(estimate.mean() == 3.0);
    CHECK(std::isinf(estimate.standard_error()));
    CHECK(std::isinf(estimate.expanded_uncertainty()));
    estimate.add(3.0);
    CHECK(estimate.standard_error() == 0.0);
}

TEST_CASE("A large constant does not make the error negative or undefined", "[unit]") {
    Estimate estimate;
    for (int i = 0; i < 100; ++i) estimate.add(1e8 + 1e-9 * i);
    CHECK(estimate.standard_error() >= 0.0);
    CHECK(std::isfinite(estimate.standard_error()));
}

TEST_CASE("Merging runs equals one long run", "[property]") {
    RandomStream random(2, 0, RandomPurpose::test, 0);
    Estimate all;
    Estimate first;
    Estimate second;
    for (int i = 0; i < 1000; ++i) {
        const double value = random.uniform();
        const double bias = random.uniform();
        all.add(value, bias);
        (i < 300 ? first : second).add(value, bias);
    }
    first.merge(second);
    CHECK(first.count() == all.count());
    CHECK_THAT(first.mean(), WithinRel(all.mean(), 1e-13));
    CHECK_THAT(first.standard_error(), WithinRel(all.standard_error(), 1e-12));
    CHECK_THAT(first.bias(), WithinRel(all.bias(), 1e-13));
    CHECK_THAT(first.bias_standard_error(), WithinRel(all.bias_standard_error(), 1e-12));
}

TEST_CASE("The standard error is the spread of means", "[statistical]") {
    // Uniform numbers have variance 1/12; 400 of them a standard error of sqrt(1 / 4800).
    RandomStream random(4, 0, RandomPurpose::test, 0);
    double mean_square = 0.0;
    const int runs = 500;
    for (int run = 0; run < runs; ++run) {
        Estimate estimate;
        for (int i = 0; i < 400; ++i) estimate.add(random.uniform());
        mean_square += std::pow(estimate.standard_error(), 2) / runs;
    }
    // Relative spread of a variance of 400 uniform numbers: sqrt(0.8 / 400) = 4.5 %, over 500 runs
    // 0.2 %; five of it.
    CHECK_THAT(mean_square, WithinRel(1.0 / 4800.0, 0.01));
}

TEST_CASE("The expanded uncertainty covers the truth as often as it says", "[statistical]") {
    // Sums of 12 uniform numbers are nearly normal; 6 phases make t differ much from 2.
    const double coverage = GENERATE(0.90, 0.95, 0.99);
    RandomStream random(6, 0, RandomPurpose::test, 0);
    int covered = 0;
    int covered_by_two = 0;
    const int runs = 4000;
    for (int run = 0; run < runs; ++run) {
        Estimate estimate;
        for (int phase = 0; phase < 6; ++phase) {
            double sum = 0.0;
            for (int i = 0; i < 12; ++i) sum += random.uniform();
            estimate.add(sum);
        }
        const double error = std::abs(estimate.mean() - 6.0);
        if (error <= estimate.expanded_uncertainty(coverage)) ++covered;
        if (error <= 1.96 * estimate.standard_error()) ++covered_by_two;
    }
    const double limit = 4.9 * std::sqrt(coverage * (1.0 - coverage) / runs);
    CHECK_THAT(covered / static_cast<double>(runs), WithinAbs(coverage, limit));
    // Twin: a normal quantile claims 95 % and does not reach it with six phases.
    CHECK(covered_by_two / static_cast<double>(runs) < 0.92);
}

TEST_CASE("The measured bias is taken off, and its noise counts", "[unit]") {
    Estimate estimate;
    // v - b: 8, 10, 9; mean 9, SE^2 = 2 / 6
    estimate.add(9.0, 1.0);
    estimate.add(10.0, 0.0);
    estimate.add(11.0, 2.0);
    CHECK_THAT(estimate.value(), WithinRel(9.0, 1e-14));
    CHECK_THAT(estimate.standard_error(), WithinRel(std::sqrt(2.0 / 6.0), 1e-13));
    // Of the bias 1 +/- sqrt(1 / 3) half may be left: (1 - 1 / 3) / 4 = 1 / 6, as a square.
    CHECK_THAT(estimate.bias_left(), WithinRel(std::sqrt(1.0 / 6.0), 1e-13));
    CHECK_THAT(estimate.expanded_uncertainty(),
               WithinRel(std::hypot(student_t(0.95, 2.0) * std::sqrt(2.0 / 6.0),
                                    0.95 * std::sqrt(1.0 / 6.0)),
                         1e-9));
    CHECK_THAT(estimate.mean(), WithinRel(10.0, 1e-14));
    CHECK_THAT(estimate.mean_standard_error(), WithinRel(std::sqrt(2.0 / 6.0), 1e-13));
    // Half of it: v - b / 2 = 8.5, 10, 10; mean 9.5, squares 1 + 0.25 + 0.25
    CHECK_THAT(estimate.value(0.5), WithinRel(9.5, 1e-14));
    CHECK_THAT(estimate.standard_error(0.5), WithinRel(std::sqrt(1.5 / 6.0), 1e-13));
}

TEST_CASE("As much of a bias is taken off as lowers the error of such values", "[statistical]") {
    // Values with a bias of their own, known to be 0.5 on root mean square, and measured with noise
    // that the values share in part. Over many of them no share does better than the one chosen.
    constexpr double expected = 0.5, truth = 10.0;
    constexpr int values = 4000, phases = 100;
    const double noise_of_bias = GENERATE(0.5, 3.0, 12.0);
    RandomStream random(9, 0, RandomPurpose::test, 0);
    const auto normal = [&] {
        double sum = -6.0;
        for (int i = 0; i < 12; ++i) sum += random.uniform();
        return sum;
    };
    double chosen = 0.0;
    std::vector<double> fixed(21);
    for (int value = 0; value < values; ++value) {
        const double bias = expected * normal();
        Estimate estimate;
        for (int phase = 0; phase < phases; ++phase) {
            const double noise = normal();
            estimate.add(truth + bias + noise,
                         bias + noise_of_bias * (0.6 * noise + 0.8 * normal()));
        }
        chosen += square(estimate.value(estimate.corrected_share(expected)) - truth) / values;
        for (std::size_t i = 0; i < fixed.size(); ++i) {
            fixed[i] += square(estimate.value(0.05 * static_cast<double>(i)) - truth) / values;
        }
    }
    const double best = *std::min_element(fixed.begin(), fixed.end());
    // What it costs that shares follow the noise of variances over phases (one in their number),
    // and that a clear bias counts as measured, is less than 10 %. The errors of all shares go
    // together.
    CHECK(chosen < 1.1 * best);
    // Twins: with all or nothing taken off the error is larger, but where all is best.
    CHECK(fixed.front() > 1.2 * best);
    if (noise_of_bias > 1.0) CHECK(fixed.back() > 1.3 * best);
}

TEST_CASE("A bias that is clear of its noise is taken off whatever is expected", "[unit]") {
    Estimate estimate;
    for (int i = 0; i < 100; ++i) estimate.add(10.0 + 0.1 * (i % 2), 2.0 + 0.4 * (i / 2 % 2));
    // Of 2.2 +/- 0.02 the noise tells nothing about the value.
    CHECK_THAT(estimate.bias(), WithinRel(2.2, 1e-12));
    CHECK_THAT(estimate.bias_standard_error(), WithinRel(0.2 / std::sqrt(99.0), 1e-9));
    CHECK_THAT(estimate.corrected_share(0.0), WithinAbs(1.0, 1e-4));
    // Twin: one that is not is left where none is expected.
    Estimate unclear;
    for (int i = 0; i < 100; ++i) unclear.add(10.0 + 0.1 * (i % 2), 2.2 * (i / 2 % 2 ? 5.0 : -4.0));
    CHECK(unclear.bias() > 1.0);
    CHECK_THAT(unclear.corrected_share(0.0), WithinAbs(0.0, 1e-12));
    // Few phases know their noise badly: 4 standard deviations are as many standard errors as
    // Student's t has for the same probability.
    for (const int phases : {10, 40, 300}) {
        const double t = student_t(1.0 - 6.334e-5, phases - 1.0);
        for (const double errors : {0.9 * t, 1.1 * t}) {
            Estimate few;
            for (int i = 0; i < phases; ++i) {
                few.add(10.0, errors / std::sqrt(phases - 1.0) + (i % 2 ? 1.0 : -1.0));
            }
            CHECK((few.corrected_share(0.0) > 0.5) == (errors > t));
        }
    }
    // A single phase tells nothing of either: the bias is taken off.
    Estimate single;
    single.add(10.0, 2.0);
    CHECK(single.corrected_share(0.0) == 1.0);
}

TEST_CASE("What is left of a bias beside an edge lies within the interval", "[unit]") {
    // An edge that the wide kernel reaches, but not the one of radius r / sqrt 2: the value is off
    // by b, two radii tell 2 b, and the corrected value is off by -b, whatever the number of
    // phases.
    constexpr double truth = 10.0, off = 0.3;
    Estimate beside_edge;
    for (int i = 0; i < 1000; ++i) {
        const double noise = 0.01 * (i % 5 - 2);
        beside_edge.add(truth + off + noise, 2.0 * off);
    }
    CHECK_THAT(beside_edge.value(), WithinRel(truth - off, 1e-12));
    CHECK(beside_edge.bias_left() >= off * (1.0 - 1e-12));
    CHECK(beside_edge.expanded_uncertainty() > 0.94 * off);
    // Twin: noise alone claims far less.
    CHECK(student_t(0.95, 999.0) * beside_edge.standard_error() < 0.01 * off);
    // Noise of the bias alone is no bias.
    Estimate noisy;
    for (int i = 0; i < 100; ++i) noisy.add(truth, i % 2 ? 1.0 : -1.0);
    CHECK(noisy.bias_left() == 0.0);
}

TEST_CASE("The bias of a step counts as far as noise does not explain it", "[unit]") {
    // Along x 4, 6, 5: mean 5, variance of the mean 2 / 6; along y -1, 1, 0: the same.
    const auto three_phases = [](const Vec3& slope) {
        StepBias bias;
        for (const double noise : {-1.0, 1.0, 0.0}) {
            bias.add(slope, Vec3(5.0 + noise, noise, 0.0));
        }
        return bias;
    };
    const double beyond = std::sqrt(25.0 - 2.0 * (2.0 / 6.0 + 2.0 / 6.0));
    CHECK_THAT(three_phases(Vec3(2, 0, 0)).beyond_noise(), WithinRel(beyond, 1e-13));
    CHECK_THAT(three_phases(Vec3(-2, 0, 0)).beyond_noise(), WithinRel(0.25 * beyond, 1e-13));
    StepBias joined = three_phases(Vec3(2, 0, 0));
    joined.merge(three_phases(Vec3(2, 0, 0)));
    // Twice as many: 4 / (6 * 5) each.
    CHECK_THAT(joined.beyond_noise(),
               WithinRel(std::sqrt(25.0 - 2.0 * (4.0 / 30.0 + 4.0 / 30.0)), 1e-13));
    StepBias noisy;
    CHECK(noisy.beyond_noise() == 0.0);
    for (int i = 0; i < 100; ++i) noisy.add(Vec3(1, 0, 0), Vec3(i % 2 ? 1.0 : -1.0, 0.0, 0.0));
    CHECK(noisy.beyond_noise() == 0.0);
}

TEST_CASE("The least of several candidates has a wider interval", "[unit]") {
    const Uncertain one{10.0, 0.5, 20.0};
    Uncertain of_five = one;
    of_five.candidates = 5.0;
    CHECK_THAT(one.expanded_uncertainty(), WithinRel(0.5 * student_t(0.95, 20.0), 1e-9));
    CHECK_THAT(of_five.expanded_uncertainty(), WithinRel(0.5 * student_t(0.99, 20.0), 1e-9));
    CHECK(std::isinf(Uncertain{10.0, 0.5, 0.0}.expanded_uncertainty()));
}
