// The statistics of the truth tests: batches of phases of one run.
#include "tests/support/truth_checks.h"

using namespace lucerna;
using namespace lucerna::optics;
using validation::SceneBuilder;

TEST_CASE("Batches of one phase are the phases, and longer ones hold the same mean", "[unit]") {
    SceneBuilder scene;
    for (const Shape& wall : SceneBuilder::room(1.0, 1.0, 1.0)) {
        scene.area_light(scene.object("wall", wall, scene.diffuse(0.5)), 100.0);
    }
    scene.meter({0.5, 0.5, 0.5}, {0.2, 0.0, 0.1}, 0.4);
    const auto read = [](const Result& result) {
        const Estimate& meter = result.quantities[0].estimate;
        return std::vector<test::Replicates::Value>{{meter.mean(), meter.bias()}};
    };
    constexpr std::uint32_t phases = 24, rays = 500;
    const Estimate run = test::run(scene, Method::combined, {phases, rays}).quantities[0].estimate;
    const auto single = test::over_batches(scene, Method::combined, {1, rays}, phases, read);
    const auto longer = test::over_batches(scene, Method::combined, {4, rays}, phases / 4, read);
    REQUIRE(single.size() == 1);
    CHECK(single[0].count() == phases);
    CHECK(longer[0].count() == phases / 4);
    REQUIRE(run.standard_error() > 0.0);
    for (const Estimate& batches : {single[0], longer[0]}) {
        CHECK(batches.mean() == Approx(run.mean()).epsilon(1e-9));
        CHECK(batches.bias() == Approx(run.bias()).epsilon(1e-6));
    }
    CHECK(single[0].standard_error() == Approx(run.standard_error()).epsilon(1e-6));
    // Means up to each phase, in place of those of its batch, would hardly spread.
    CHECK(longer[0].standard_error() > 0.3 * run.standard_error());
}
