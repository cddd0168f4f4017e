// However threads share the work, the means are the same (docs/method.md, threads).
#include <catch2/catch.hpp>

#include "optics/transport/simulate.h"
#include "tests/support/check_mean.h"
#include "tests/support/cornell_scenes.h"
#include "validation/scene_builder.h"

using namespace lucerna;
using namespace lucerna::optics;

namespace {

Result run(Scheduler scheduler, int threads, std::uint64_t seed) {
    const int pixels = 24;
    const auto scene = test::cornell_caustic(pixels);
    Settings settings;
    settings.method = Method::combined;
    settings.scheduler = scheduler;
    settings.threads = threads;
    settings.seed = seed;
    settings.samples_per_pixel = 4;
    settings.max_phases = 4;
    // Few rays, so that those of other groups are many of those that a map takes.
    settings.forward_rays = 3000;
    return simulate(scene.parts, settings);
}

}  // namespace

TEST_CASE("Schedulers agree in the mean at 1, 2, 4 and 8 threads", "[statistical]") {
    constexpr std::uint64_t seeds = 12;
    static const std::vector<Result> truths = [] {
        std::vector<Result> results;
        for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
            results.push_back(run(Scheduler::ordered, 1, seed));
        }
        return results;
    }();
    const auto scheduler = GENERATE(Scheduler::synchronous, Scheduler::two_level);
    const auto threads = GENERATE(1, 2, 4, 8);
    INFO("scheduler " << static_cast<int>(scheduler) << " threads " << threads);
    // The same rays, added in another order, need few seeds.
    const bool same_rays = scheduler == Scheduler::synchronous;
    Estimate image, absorbed;  // ratios to the ordered scheduler with the same seed
    for (std::uint64_t seed = 1; seed <= (same_rays ? 3 : seeds); ++seed) {
        const Result& truth = truths[seed - 1];
        const Result result = run(scheduler, threads, seed);
        image.add(result.images[0].mean.value() / truth.images[0].mean.value());
        const auto lost = [](const Result& r) {
            return r.flux_balance_lm.escaped / r.flux_balance_lm.emitted;
        };
        absorbed.add(lost(result) / lost(truth));
        CHECK(std::abs(result.flux_balance_lm.closure()) < 1e-6 * result.flux_balance_lm.emitted);
    }
    if (same_rays) {
        CHECK(std::abs(image.mean() - 1.0) < 1e-5);
        CHECK(image.standard_error() < 1e-5);
        CHECK(std::abs(absorbed.mean() - 1.0) < 1e-9);
        return;
    }
    test::check_mean(image.mean(), image.standard_error(), 1.0, {0.03});
    test::check_mean(absorbed.mean(), absorbed.standard_error(), 1.0, {0.03});
    CHECK_FALSE(test::agrees(image.mean(), image.standard_error(), 1.03));
}

TEST_CASE("A sensor looks through a pane alike with every scheduler") {
    validation::SceneBuilder scene;
    scene.area_light(
        scene.object("lamp", Rectangle{{-1, -1, 2}, {0, 2, 0}, {2, 0, 0}}, scene.black()), 1000.0);
    Placement place = Placement::Identity();
    place.translate(Vec3(-1.0, -1.0, 1.5));
    scene.solid("pane", Box{place, {2.0, 2.0, 0.01}}, scene.medium(1.5));
    scene.object("floor", Rectangle{{-1, -1, 0}, {2, 0, 0}, {0, 2, 0}}, scene.black());
    scene.points({Vec3::Zero()}, Vec3::UnitZ());
    const auto illuminance = [&](Scheduler scheduler) {
        Settings settings;
        settings.scheduler = scheduler;
        settings.threads = 2;
        settings.max_phases = 4;
        return simulate(scene.parts, settings).quantities[0].estimate;
    };
    const Estimate ordered = illuminance(Scheduler::ordered);
    CHECK(ordered.bias() == 0.0);  // no kernel
    CHECK(ordered.standard_error() < 0.02 * ordered.mean());
    for (const Scheduler other :
         {Scheduler::synchronous, Scheduler::asynchronous, Scheduler::two_level}) {
        CHECK(std::abs(illuminance(other).mean() / ordered.mean() - 1.0) < 1e-6);
    }
}
