// Every path of light is counted once: four methods that divide it differently agree.
#include <catch2/catch.hpp>

#include "optics/transport/simulate.h"
#include "tests/support/check_mean.h"
#include "tests/support/cornell_scenes.h"

using namespace lucerna;
using namespace lucerna::optics;

namespace {

constexpr int pixels = 64;

Image render(const validation::SceneBuilder& scene, Method method, PlantedError planted,
             std::uint32_t phases) {
    Settings settings;
    settings.method = method;
    settings.seed = 100 + static_cast<std::uint64_t>(method);  // independent runs
    settings.max_phases = phases;
    settings.forward_rays = 20000;
    settings.samples_per_pixel = 4;
    settings.planted_error = planted;
    return simulate(scene.parts, settings).images.front();
}

// |difference| of two estimates in its standard errors.
double distance(const Estimate& a, const Estimate& b) {
    return std::abs(a.value() - b.value()) / std::hypot(a.standard_error(), b.standard_error());
}

double worst_tile(const Image& a, const Image& b) {
    double worst = distance(a.mean, b.mean);
    for (std::size_t i = 0; i < a.tiles.size(); ++i) {
        worst = std::max(worst, distance(a.tiles[i], b.tiles[i]));
    }
    return worst;
}

}  // namespace

TEST_CASE("The methods agree on a diffuse room", "[statistical]") {
    const auto scene = test::cornell_diffuse(pixels);
    const Image referee = render(scene, Method::path, PlantedError::none, 64);
    for (const Method method : {Method::combined, Method::forward, Method::backward}) {
        INFO("method " << static_cast<int>(method));
        const Image image = render(scene, method, PlantedError::none, 48);
        CHECK(image.mean.standard_error() < 0.004 * image.mean.value());
        CHECK(worst_tile(image, referee) < test::level_1e6);
    }
}

TEST_CASE("The methods agree on a room with caustics", "[statistical]") {
    const auto scene = test::cornell_caustic(pixels);
    const Image combined = render(scene, Method::combined, PlantedError::none, 64);
    for (const Method method : {Method::forward, Method::backward, Method::path}) {
        INFO("method " << static_cast<int>(method));
        CHECK(worst_tile(combined, render(scene, method, PlantedError::none, 64)) <
              test::level_1e6);
    }
}

TEST_CASE("A planted double count and a planted gap are seen", "[statistical]") {
    const auto scene = test::cornell_caustic(pixels);
    const Image honest = render(scene, Method::backward, PlantedError::none, 48);
    for (const PlantedError planted : {PlantedError::double_count, PlantedError::gap}) {
        CHECK(worst_tile(honest, render(scene, Method::combined, planted, 48)) > test::level_1e6);
    }
}
