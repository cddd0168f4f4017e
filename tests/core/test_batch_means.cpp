#include "core/batch_means.h"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>

#include "core/random.h"

using namespace lucerna;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

// Two values that share most of their noise, as readings that share photons do.
std::array<double, 2> phase_values(RandomStream& random) {
    const double shared = random.uniform() - 0.5;
    return {10.0 + 6.0 * shared + (random.uniform() - 0.5),
            20.0 + 12.0 * shared + 2.0 * (random.uniform() - 0.5)};
}

double ratio_of_means(auto&& mean) {
    return mean(0) / mean(1);
}

}  // namespace

TEST_CASE("The mean of one value has its usual standard error", "[unit]") {
    const std::uint32_t phases = GENERATE(5u, 64u);
    BatchMeans batches(1);
    Estimate estimate;
    RandomStream random(1, 0, RandomPurpose::test, 0);
    for (std::uint32_t i = 0; i < phases; ++i) {
        const double value = 3.0 + random.uniform();
        batches.add(std::span(&value, 1));
        estimate.add(value);
    }
    const Uncertain mean = batches.of([](auto&& m) { return m(0); });
    CHECK_THAT(mean.value, WithinRel(estimate.mean(), 1e-13));
    CHECK_THAT(mean.standard_error, WithinRel(estimate.standard_error(), 1e-10));
    CHECK(mean.degrees_of_freedom == estimate.degrees_of_freedom());
}

TEST_CASE("Batches are joined when there are many, and no phase is lost", "[property]") {
    const std::uint32_t phases = GENERATE(63u, 65u, 127u, 128u, 129u, 1000u, 5001u);
    BatchMeans batches(2);
    Estimate first;
    RandomStream random(2, 0, RandomPurpose::test, 0);
    for (std::uint32_t i = 0; i < phases; ++i) {
        const auto values = phase_values(random);
        batches.add(values);
        first.add(values[0]);
    }
    CHECK(batches.phases() == phases);
    CHECK_THAT(batches.mean(0), WithinRel(first.mean(), 1e-13));
    const Uncertain mean = batches.of([](auto&& m) { return m(0); });
    // 32 to 64 batches know a standard error to 13 % (one standard deviation); five of it.
    CHECK_THAT(mean.standard_error, WithinRel(first.standard_error(), 0.65));
    CHECK(mean.degrees_of_freedom >= 31.0);
    CHECK(batches.bytes() <= 2 * 2 * BatchMeans::most_batches * sizeof(double));
}

TEST_CASE("The error of a ratio of values that share their noise covers", "[statistical]") {
    int covered = 0;
    int covered_if_independent = 0;
    const int runs = 2000;
    RandomStream random(3, 0, RandomPurpose::test, 0);
    for (int run = 0; run < runs; ++run) {
        BatchMeans batches(2);
        Estimate a;
        Estimate b;
        for (int phase = 0; phase < 90; ++phase) {
            const auto values = phase_values(random);
            batches.add(values);
            a.add(values[0]);
            b.add(values[1]);
        }
        const Uncertain ratio = batches.of([](auto&& m) { return ratio_of_means(m); });
        if (std::abs(ratio.value - 0.5) <= ratio.expanded_uncertainty()) ++covered;
        // The twin that must fail: errors added as if they were independent.
        const double independent =
            ratio.value * std::hypot(a.standard_error() / a.mean(), b.standard_error() / b.mean());
        if (std::abs(ratio.value - 0.5) <= 1.96 * independent) ++covered_if_independent;
    }
    CHECK_THAT(covered / static_cast<double>(runs),
               WithinAbs(0.95, 4.9 * std::sqrt(0.95 * 0.05 / runs)));
    CHECK(covered_if_independent == runs);  // much too wide
}

TEST_CASE("One phase has no error", "[unit]") {
    BatchMeans batches(1);
    const double value = 2.0;
    batches.add(std::span(&value, 1));
    const Uncertain mean = batches.of([](auto&& m) { return m(0); });
    CHECK(mean.value == 2.0);
    CHECK(std::isinf(mean.expanded_uncertainty()));
}

TEST_CASE("How a value follows another is told by what they share", "[statistical]") {
    // value = 50 (1 + 0.4 d + noise), other = 2 (1 + d): slope 0.4, whatever the units.
    constexpr double slope = 0.4;
    BatchMeans batches(3);
    RandomStream random(4, 0, RandomPurpose::test, 0);
    constexpr int phases = 4000;
    for (int i = 0; i < phases; ++i) {
        const double d = 0.2 * (random.uniform() - 0.5), noise = 0.1 * (random.uniform() - 0.5);
        const std::array<double, 3> values{50.0 * (1.0 + slope * d + noise), 2.0 * (1.0 + d), 7.0};
        batches.add(values);
    }
    // Of 32 to 64 batches: standard deviation of the slope (0.1 / 0.2) / sqrt(batches).
    const double error = 0.5 / std::sqrt(32.0);
    const auto slope_of = [&](std::size_t value, std::size_t other) {
        return batches.means().relative_slope(value, other, batches.covariation(value, other));
    };
    CHECK(std::abs(slope_of(0, 1) - slope) < 4.9 * error);
    CHECK_THAT(slope_of(1, 1), WithinRel(1.0, 1e-9));
    CHECK(slope_of(0, 2) == 0.0);  // tells nothing
}

TEST_CASE("Without a batch there are the mean and the slope of the others", "[property]") {
    // Two phases in each batch.
    constexpr std::uint32_t pairs = 33;
    std::vector<std::array<double, 2>> phases;
    RandomStream random(5, 0, RandomPurpose::test, 0);
    for (std::uint32_t i = 0; i < 2 * pairs; ++i) phases.push_back(phase_values(random));
    BatchMeans all(2);
    for (const auto& values : phases) all.add(values);
    const auto together = all.covariation(0, 1);
    std::vector<double> seen_means, seen_slopes;
    const auto see = [&](const BatchMeans::Means& means) {
        seen_means.push_back(means(0));
        seen_slopes.push_back(means.relative_slope(0, 1, together));
        return 0.0;
    };
    all.of(see);
    REQUIRE(all.batches() == pairs);
    REQUIRE(seen_means.size() == pairs + 1);
    for (std::uint32_t left_out = 0; left_out < pairs; ++left_out) {
        std::array<double, 2> mean{};
        for (std::uint32_t i = 0; i < 2 * pairs; ++i) {
            if (i / 2 == left_out) continue;
            for (std::size_t k = 0; k < 2; ++k) mean[k] += phases[i][k] / (2.0 * (pairs - 1));
        }
        double product = 0.0, square = 0.0;
        for (std::uint32_t pair = 0; pair < pairs; ++pair) {
            if (pair == left_out) continue;
            const auto deviation = [&](std::size_t k) {
                return 0.5 * (phases[2 * pair][k] + phases[2 * pair + 1][k]) / mean[k] - 1.0;
            };
            product += deviation(0) * deviation(1);
            square += deviation(1) * deviation(1);
        }
        CHECK_THAT(seen_means[left_out + 1], WithinRel(mean[0], 1e-12));
        CHECK_THAT(seen_slopes[left_out + 1], WithinRel(product / square, 1e-9));
    }
}

TEST_CASE("Joined runs have the mean and the error of all of their phases", "[property]") {
    const auto [one, other] = GENERATE(table<std::uint32_t, std::uint32_t>(
        {{40u, 50u}, {64u, 64u}, {300u, 20u}, {20u, 300u}, {129u, 1000u}, {40u, 0u}}));
    BatchMeans joined(2);
    BatchMeans second(2);
    Estimate all;
    RandomStream random(4, 0, RandomPurpose::test, 0);
    for (std::uint32_t i = 0; i < one + other; ++i) {
        const auto values = phase_values(random);
        (i < one ? joined : second).add(values);
        all.add(values[0]);
    }
    joined.merge(second);
    INFO(one << " and " << other << " phases");
    CHECK(joined.phases() == one + other);
    CHECK_THAT(joined.mean(0), WithinRel(all.mean(), 1e-13));
    const Uncertain mean = joined.of([](auto&& m) { return m(0); });
    // n batches know a standard error to 1 / sqrt(2 (n - 1)), here 4 or at least 15 of them; five
    // of it.
    CHECK(mean.standard_error > 0.0);
    CHECK_THAT(mean.standard_error,
               WithinRel(all.standard_error(), 5.0 / std::sqrt(2.0 * mean.degrees_of_freedom)));
    CHECK(mean.degrees_of_freedom < BatchMeans::most_batches);
    // Phases that follow are not lost either.
    for (std::uint32_t i = 0; i < 200; ++i) {
        const auto values = phase_values(random);
        joined.add(values);
        all.add(values[0]);
    }
    CHECK(joined.phases() == one + other + 200);
    CHECK_THAT(joined.mean(0), WithinRel(all.mean(), 1e-13));
}
