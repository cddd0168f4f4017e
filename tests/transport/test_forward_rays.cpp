// How many forward rays a phase has: as many as pay beside its backward rays.
#include "optics/transport/forward_rays.h"
#include "optics/transport/plan.h"
#include "tests/support/cornell_scenes.h"
#include "tests/support/truth_checks.h"

using namespace lucerna;
using namespace lucerna::optics;
using test::SceneBuilder;

namespace {

Plan plan_of(const SceneBuilder& scene, const Settings& settings) {
    const Stage stage(scene.parts);
    const SensorPlanes planes(stage.parts(), stage.caster(), 0.1);
    const Readings readings(scene.parts, settings);
    return make_plan({stage, planes, readings, Scheduler::ordered, 1}, settings);
}

// A ball of glass under a small lamp in a room, of which an image sees a part.
SceneBuilder ball_of_glass(double reflectance, const Vec3& target) {
    SceneBuilder scene;
    const BsdfId walls = scene.diffuse(reflectance);
    for (const Shape& wall : SceneBuilder::room(1.0, 1.0, 1.0)) scene.object("wall", wall, walls);
    scene.area_light(
        scene.object("lamp", Disk{{0.7, 0.5, 0.95}, -Vec3::UnitZ(), 0.05}, scene.black()), 1e4);
    scene.solid("ball", Sphere{{0.7, 0.5, 0.25}, 0.15}, scene.medium(1.5));
    scene.camera({0.3, 0.5, 0.5}, target, Vec3(0.1, 0.0, 1.0), 0.4, 128, 128);
    return scene;
}

}  // namespace

TEST_CASE("With the rays that pay, variance times cost is least") {
    constexpr double rays = 1000.0;
    for (const NoiseAndCost& of_map : {NoiseAndCost{3.0, 0.2}, {0.1, 5.0}, {2.0, 2.0}}) {
        const NoiseAndCost of_backward{1.5, 4.0};
        const auto effort = [&](double n) {
            return (of_backward.variance + of_map.variance * rays / n) *
                   (of_backward.cost + of_map.cost * n / rays);
        };
        const double best = rays_that_pay(rays, of_map, of_backward);
        INFO(best << " rays");
        CHECK(effort(best) < effort(1.01 * best));
        CHECK(effort(best) < effort(best / 1.01));
    }
}

TEST_CASE("Forward rays are fewer where backward rays are noisy by themselves") {
    Settings settings;
    settings.method = Method::forward;
    settings.samples_per_pixel = 8;
    // The room without its lamp in view, and with a lamp whose rim crosses pixels.
    const auto rays = [&](bool rim) {
        SceneBuilder scene = test::cornell_diffuse(0);
        scene.camera({0.5, 0.5, 2.4}, {0.5, 0.3, 0.0}, Vec3::UnitY(), 0.3, 128, 128);
        if (rim) {
            scene.area_light(
                scene.object("rim", Disk{{0.5, 0.4, 1.0}, Vec3::UnitZ(), 0.05}, scene.black()),
                20.0);
        }
        return plan_of(scene, settings).indirect_rays;
    };
    const std::uint32_t calm = rays(false);
    const std::uint32_t noisy = rays(true);
    INFO(calm << " and " << noisy << " rays");
    CHECK(calm > 2 * noisy);

    settings.forward_rays = 30000;
    CHECK(rays(true) == 30000);
}

TEST_CASE("Caustic rays that sensors need are not spared for an image") {
    const auto rays = [](bool sensor) {
        SceneBuilder scene = ball_of_glass(0.8, {0.0, 0.5, 0.9});
        if (sensor) scene.points({{0.7, 0.5, 0.01}}, Vec3::UnitZ());
        Settings settings;
        settings.method = Method::forward;
        return plan_of(scene, settings).caustic_rays;
    };
    constexpr std::uint32_t usual = 128 * 128 * 8 / 4;
    INFO(rays(true) << " and " << rays(false) << " rays");
    CHECK(rays(true) >= usual);
    CHECK(rays(false) < usual);
}

TEST_CASE("Rays go to the map whose light is the noisier in view") {
    // In a dark room the caustic is all the light that maps hold; before a bright wall there is
    // none.
    const auto plan = [](double reflectance, const Vec3& target) {
        Settings settings;
        settings.method = Method::forward;
        settings.samples_per_pixel = 8;
        return plan_of(ball_of_glass(reflectance, target), settings);
    };
    const auto indirect_paths = [](const Plan& chosen) {
        return chosen.indirect_rays * whole_paths_per_path(chosen.indirect_reach);
    };
    const Plan on_caustic = plan(0.05, {0.7, 0.5, 0.0});
    INFO("caustic " << on_caustic.caustic_rays << ", indirect " << indirect_paths(on_caustic));
    CHECK(2 * on_caustic.caustic_rays > 3 * indirect_paths(on_caustic));
    const Plan on_wall = plan(0.8, {0.0, 0.5, 0.9});
    INFO("caustic " << on_wall.caustic_rays << ", indirect " << indirect_paths(on_wall));
    CHECK(2 * indirect_paths(on_wall) > 3 * on_wall.caustic_rays);
}
