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

// A lamp over a white floor, a back wall of rough metal on which a ball of glass throws a caustic,
// and a frosted pane. A point before the pane has its light through it; meters look at that point,
// through the pane at the floor behind it, and at the metal.
validation::SceneBuilder glossy_scene() {
    const Vec3 ex = Vec3::UnitX(), ey = Vec3::UnitY(), ez = Vec3::UnitZ();
    validation::SceneBuilder scene;
    scene.object("floor", Rectangle{Vec3::Zero(), ez, ex}, scene.diffuse(0.75));
    scene.area_light(
        scene.object("lamp", Rectangle{{0.35, 0.999, 0.6}, 0.3 * ex, 0.3 * ez}, scene.black()),
        1.0);
    const BsdfId metal = scene.parts.add(Bsdf{RoughConductor{
        scene.parts.add(spectral::Spectrum(1.1)), scene.parts.add(spectral::Spectrum(6.5)), 0.3}});
    scene.object("back", Rectangle{{0.05, 0.05, 0.01}, 0.9 * ex, 0.9 * ey}, metal);
    scene.solid("ball", Sphere{{0.6, 0.5, 0.25}, 0.2}, scene.medium(1.5));
    const ObjectId pane =
        scene.solid("pane", Box{Placement(Eigen::Translation3d(0.1, 0.02, 0.8)), {0.5, 0.6, 0.02}},
                    scene.medium(1.5));
    scene.parts.objects[pane].front = scene.parts.objects[pane].back =
        scene.parts.add(Bsdf{RoughDielectric{0.1}});
    scene.points({{0.35, 0.001, 0.97}}, ey);
    scene.meter({0.35, 0.5, 2.0}, {0.35, 0.0, 0.6}, 0.01);
    scene.meter({0.68, 0.6, 1.5}, {0.65, 0.27, 0.01}, 0.02);
    return scene;
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

TEST_CASE("The methods agree behind frosted glass and on rough metal", "[statistical]") {
    const auto scene = glossy_scene();
    const auto read = [&](Method method) {
        Settings settings;
        settings.method = method;
        settings.seed = 100 + static_cast<std::uint64_t>(method);
        settings.max_phases = 8;
        return simulate(scene.parts, settings).quantities;
    };
    const std::vector<Quantity> referee = read(Method::path);
    for (const Method method : {Method::combined, Method::forward, Method::backward}) {
        const std::vector<Quantity> quantities = read(method);
        for (std::size_t i = 0; i < quantities.size(); ++i) {
            const Estimate &a = quantities[i].estimate, &b = referee[i].estimate;
            INFO("method " << static_cast<int>(method) << ", " << i << ": " << a.value() << " +- "
                           << a.standard_error() << ", " << b.value() << " +- "
                           << b.standard_error());
            CHECK(distance(a, b) < test::level_1e6);
            CHECK(a.standard_error() < 0.06 * a.value());
        }
    }
}

TEST_CASE("A planted double count and a planted gap are seen", "[statistical]") {
    const auto scene = test::cornell_caustic(pixels);
    const Image honest = render(scene, Method::backward, PlantedError::none, 48);
    for (const PlantedError planted : {PlantedError::double_count, PlantedError::gap}) {
        CHECK(worst_tile(honest, render(scene, Method::combined, planted, 48)) > test::level_1e6);
    }
}
