// Readings without the luck of the wavelengths, against the emission that is known.
#include <array>
#include <catch2/catch.hpp>

#include "core/random.h"
#include "optics/transport/calibration.h"

using namespace lucerna;
using namespace lucerna::optics;

namespace {

// Nearly normal, of mean 0 and variance 1.
double normal(RandomStream& random) {
    double sum = -6.0;
    for (int i = 0; i < 12; ++i) sum += random.uniform();
    return sum;
}

}  // namespace

TEST_CASE("U of a calibrated reading covers, though a few phases tell how it follows the emission",
          "[statistical]") {
    // A reading of 1 that follows the emission of 1 wholly, with noise of its own beside it.
    constexpr double luck = 0.005;
    constexpr int phases = 19, runs = 20000;
    const double own_noise = GENERATE(0.4, 2.0) * luck;
    const Vec3 emission(1.0, 1.0, 1.0);
    int covered = 0, covered_by_one_slope = 0;
    RandomStream random(1, 0, RandomPurpose::test, 0);
    for (int run = 0; run < runs; ++run) {
        BatchMeans sums(6);
        for (int phase = 0; phase < phases; ++phase) {
            const double e = 1.0 + luck * normal(random);
            const double y = e + own_noise * normal(random);
            sums.add(std::array{y, y, y, e, e, e});
        }
        const Uncertain reading =
            Calibration(sums, emission).of([](auto&& value) { return value(0, 1); });
        CHECK(reading.degrees_of_freedom == phases - 2);
        if (std::abs(reading.value - 1.0) <= reading.expanded_uncertainty()) ++covered;
        // The twin that must fail: as if the slope were known.
        const double slope =
            std::clamp(sums.means().relative_slope(1, 4, sums.covariation(1, 4)), 0.0, 1.0);
        Uncertain twin = sums.of([&](auto&& mean) { return mean(1) * std::pow(mean(4), -slope); });
        twin.degrees_of_freedom -= 1.0;
        CHECK(std::abs(twin.value - reading.value) < 1e-12);
        if (std::abs(twin.value - 1.0) <= twin.expanded_uncertainty()) ++covered_by_one_slope;
    }
    const double deviation = std::sqrt(0.95 * 0.05 / runs);
    INFO("noise of its own " << own_noise << ": " << covered << " and, by one slope, "
                             << covered_by_one_slope << " of " << runs);
    CHECK(std::abs(covered / double{runs} - 0.95) < 4.9 * deviation);
    CHECK(covered_by_one_slope / double{runs} < 0.95 - 4.9 * deviation);
}
