// Scenes whose truth is known in closed form or by independent quadrature.
#include <catch2/catch.hpp>

#include "optics/transport/simulate.h"
#include "tests/support/check_mean.h"
#include "tests/support/scene_builder.h"

using namespace lucerna;
using namespace lucerna::optics;
using test::SceneBuilder;

namespace {

Settings settings(Method method, std::uint32_t phases, std::uint32_t forward_rays = 20000) {
    Settings settings;
    settings.method = method;
    settings.seed = 7;
    settings.max_phases = phases;
    settings.forward_rays = forward_rays;
    return settings;
}

// Kernel bias, as measured, is a bound that adds to the noise.
void check(const Quantity& quantity, double truth, double detects) {
    INFO(quantity.name << " bias " << quantity.estimate.bias() << " +/- "
                       << quantity.estimate.bias_standard_error());
    test::check_mean(quantity.estimate.mean(), quantity.estimate.standard_error(), truth, {detects},
                     std::abs(quantity.estimate.bias()));
}

}  // namespace

TEST_CASE("Closed furnace: L = L_e / (1 - rho) everywhere", "[analytic]") {
    const double rho = GENERATE(0.2, 0.5, 0.9);
    const auto method = GENERATE(Method::combined, Method::forward, Method::backward, Method::path);
    const double emitted = 100.0;  // cd/m2
    SceneBuilder scene;
    for (const Shape& wall : SceneBuilder::room(1.0, 1.3, 0.8)) {
        scene.area_light(scene.object("wall", wall, scene.diffuse(rho)), emitted);
    }
    scene.meter({0.5, 0.6, 0.4}, {0.2, 0.0, 0.1}, 0.1);
    scene.meter({0.5, 0.6, 0.4}, {0.0, 0.0, 0.0}, 0.05);  // a corner
    const Result result = simulate(scene.parts, settings(method, 24));
    INFO("rho " << rho << " method " << static_cast<int>(method));
    for (const Quantity& quantity : result.quantities) {
        check(quantity, emitted / (1.0 - rho), 0.02);
    }
}
