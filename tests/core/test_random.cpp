#include "core/random.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

using namespace lucerna;
using Catch::Matchers::WithinAbs;

namespace {

std::vector<double> numbers(RandomStream stream, int count) {
    std::vector<double> values;
    for (int i = 0; i < count; ++i) values.push_back(stream.uniform());
    return values;
}

double chi_square(const std::vector<int>& counts, double expected) {
    double sum = 0.0;
    for (const int count : counts) sum += (count - expected) * (count - expected) / expected;
    return sum;
}

// Quantile of chi-square for a chance of 1e-6 above it (Wilson and Hilferty 1931), z = 4.753.
double chi_square_limit(double degrees) {
    const double a = 2.0 / (9.0 * degrees);
    return degrees * std::pow(1.0 - a + 4.753 * std::sqrt(a), 3);
}

// The published bijection on which the streams rest, written out: Philox4x32-10 of Salmon, Moraes,
// Dror and Shaw, SC'11, section 3.3.
std::array<std::uint32_t, 4> philox(std::array<std::uint32_t, 4> c,
                                    std::array<std::uint32_t, 2> k) {
    for (int round = 0; round < 10; ++round) {
        const std::uint64_t a = std::uint64_t{0xD2511F53} * c[0];
        const std::uint64_t b = std::uint64_t{0xCD9E8D57} * c[2];
        c = {static_cast<std::uint32_t>(b >> 32) ^ c[1] ^ k[0], static_cast<std::uint32_t>(b),
             static_cast<std::uint32_t>(a >> 32) ^ c[3] ^ k[1], static_cast<std::uint32_t>(a)};
        k[0] += 0x9E3779B9;
        k[1] += 0xBB67AE85;
    }
    return c;
}

}  // namespace

TEST_CASE("The reference of the generator passes its known answer", "[unit]") {
    // Known-answer test of the Random123 distribution for all bits set.
    CHECK(philox({~0u, ~0u, ~0u, ~0u}, {~0u, ~0u}) ==
          std::array<std::uint32_t, 4>{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd});
}

TEST_CASE("A stream is Philox4x32-10 of its names", "[unit]") {
    RandomStream stream(0x0123456789ABCDEFull, 42, RandomPurpose::test, 7);
    for (std::uint32_t block = 0; block < 5; ++block) {
        const auto expected =
            philox({block, static_cast<std::uint32_t>(RandomPurpose::test), 42, 7},
                   {0x89ABCDEF, 0x01234567});
        for (const std::uint32_t bits : expected) CHECK(stream.uniform() == bits * 0x1p-32);
    }
}

TEST_CASE("A stream depends on each of its names and on nothing else", "[property]") {
    const auto reference = numbers(RandomStream(1, 2, RandomPurpose::test, 3), 16);
    CHECK(numbers(RandomStream(1, 2, RandomPurpose::test, 3), 16) == reference);
    CHECK(numbers(RandomStream(2, 2, RandomPurpose::test, 3), 16) != reference);
    CHECK(numbers(RandomStream(1 + (1ull << 32), 2, RandomPurpose::test, 3), 16) != reference);
    CHECK(numbers(RandomStream(1, 3, RandomPurpose::test, 3), 16) != reference);
    CHECK(numbers(RandomStream(1, 2, RandomPurpose::pilot, 3), 16) != reference);
    CHECK(numbers(RandomStream(1, 2, RandomPurpose::test, 4), 16) != reference);
}

TEST_CASE("Numbers of a stream are uniform in [0, 1)", "[statistical]") {
    RandomStream stream(5, 0, RandomPurpose::test, 0);
    std::vector<int> counts(256, 0);
    for (int i = 0; i < 256000; ++i) {
        const double u = stream.uniform();
        REQUIRE(u >= 0.0);
        REQUIRE(u < 1.0);
        ++counts[static_cast<std::size_t>(u * 256.0)];
    }
    CHECK(chi_square(counts, 1000.0) < chi_square_limit(255.0));
    // Twin: 5 % more in every other cell is noticed.
    for (std::size_t i = 0; i < counts.size(); i += 2) counts[i] += 50;
    CHECK(chi_square(counts, 1000.0) > chi_square_limit(255.0));
}

TEST_CASE("Neighbours are independent along dimensions, paths and phases", "[statistical]") {
    enum class Along { dimension, path, phase, seed };
    const Along along = GENERATE(Along::dimension, Along::path, Along::phase, Along::seed);
    std::vector<int> counts(16 * 16, 0);
    for (std::uint32_t i = 0; i < 100000; ++i) {
        RandomStream a(9, 1, RandomPurpose::test, i);
        const double first = a.uniform();
        double second = 0.0;
        switch (along) {
            case Along::dimension:
                second = a.uniform();
                break;
            case Along::path:
                second = RandomStream(9, 1, RandomPurpose::test, i + 1).uniform();
                break;
            case Along::phase:
                second = RandomStream(9, 2, RandomPurpose::test, i).uniform();
                break;
            case Along::seed:
                second = RandomStream(10, 1, RandomPurpose::test, i).uniform();
                break;
        }
        ++counts[static_cast<std::size_t>(first * 16.0) * 16 +
                 static_cast<std::size_t>(second * 16.0)];
    }
    CHECK(chi_square(counts, 100000.0 / 256.0) < chi_square_limit(255.0));
}
