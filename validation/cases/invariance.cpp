// What glass does to luminance: nothing behind a window or a ball, n^2 within.
#include <fmt/format.h>

#include "validation/cases.h"
#include "validation/scene_builder.h"
#include "validation/truth/tilted_slab.h"

namespace lucerna::validation {
namespace {

using namespace optics;

// A clear window between two wide emitters; meters look at the window from above, and at the lower
// emitter from within the glass.
Case window(const std::string& id, const std::string& title, double index, double below,
            double above, const optics::Settings& settings = effort(96, 100, 100)) {
    constexpr double thickness_m = 0.1;
    SceneBuilder scene;
    scene.area_light(
        scene.object("below", Rectangle{{-9, -9, 0}, {18, 0, 0}, {0, 18, 0}}, scene.black()),
        below);
    scene.area_light(
        scene.object("above", Rectangle{{-9, -9, 1}, {0, 18, 0}, {18, 0, 0}}, scene.black()),
        above);
    Placement place = Placement::Identity();
    place.translate(Vec3(-8.0, -8.0, 0.2));
    scene.solid("window", Box{place, {16.0, 16.0, thickness_m}}, scene.medium(index));

    Case result{.id = id,
                .title = title,
                .source =
                    "T L1 + (1 - T) L2 behind the window; within it n^2 (L1 + R L2) / (1 + R) "
                    "for s and p apart: L / n^2 is invariant (Born and Wolf, 7th ed., 4.8.1)",
                .scene = {},
                .settings = settings,
                .checks = {}};
    for (const double degrees : {0.0, 45.0, 70.0}) {
        const double angle = degrees * pi / 180.0;
        const Vec3 target(0.0, 0.0, 0.2 + thickness_m);
        scene.meter(target + 0.5 * Vec3(std::sin(angle), 0.0, std::cos(angle)), target, 0.001);
        const double t = truth::slab_transmittance(index, angle, thickness_m, 0.0);
        const double truth = t * below + (1.0 - t) * above;
        result.checks.push_back({fmt::format("window at {:g} deg", degrees), "luminance", "cd/m2",
                                 truth, 1e-5 * truth, sensor(result.checks.size())});
    }
    for (const double degrees : {0.0, 50.0}) {  // outside; inside by Snell's law
        const double outside = degrees * pi / 180.0;
        const double sine = std::sin(outside) / index;
        const Vec3 middle(0.0, 0.0, 0.2 + 0.5 * thickness_m);
        scene.meter(middle, middle + Vec3(sine, 0.0, -std::sqrt(1.0 - sine * sine)), 0.001);
        const truth::Reflection r = truth::reflection(1.0, index, std::cos(outside));
        // Upward light L_u = (1 - R) L1 + R L_d and downward light L_d = (1 - R) L2 + R L_u.
        const auto upward = [&](double reflectance) {
            return (below + reflectance * above) / (1.0 + reflectance);
        };
        const double truth =
            index * index * 0.5 * (upward(r.reflectance_s()) + upward(r.reflectance_p()));
        result.checks.push_back({fmt::format("within, toward {:g} deg outside", degrees),
                                 "luminance", "cd/m2", truth, 1e-5 * truth,
                                 sensor(result.checks.size())});
    }
    result.scene = std::move(scene.parts);
    return result;
}

// A ball of clear glass in a furnace of uniform luminance L = Le / (1 - rho).
Case ball(const std::string& id, double index, double rho,
          const optics::Settings& settings = effort(128, 8000, 16)) {
    constexpr double emitted = 1000.0;
    const Vec3 centre(0.5, 0.5, 0.5);
    SceneBuilder scene;
    for (const Shape& wall : SceneBuilder::room(1.0, 1.0, 1.0)) {
        scene.area_light(scene.object("wall", wall, scene.diffuse(rho)), emitted);
    }
    scene.solid("ball", Sphere{centre, 0.3}, scene.medium(index));
    scene.meter({0.05, 0.05, 0.1}, {0.6, 0.55, 0.5}, 0.05);
    scene.meter(centre, {0.9, 0.2, 0.3}, 0.4);
    scene.points({centre}, Vec3::UnitZ());
    const double luminance = emitted / (1.0 - rho);
    const double within = index * index * luminance;
    return {
        .id = id,
        .title = fmt::format("ball of n = {:g} in a furnace of reflectance {:g}", index, rho),
        .source =
            "L = Le / (1 - rho) in air and n^2 L in glass: L / n^2 is invariant and a "
            "lossless ball gives what it takes (Born and Wolf, 7th ed., 4.8.1)",
        .scene = std::move(scene.parts),
        .settings = settings,
        .checks = {
            {"the ball from outside", "luminance", "cd/m2", luminance, 0.0, sensor(0), 0.03},
            {"the walls from within", "luminance", "cd/m2", within, 0.0, sensor(1)},
            {"the centre of the ball", "illuminance", "lx", pi * within, 0.0, sensor(2), 0.04}}};
}

}  // namespace

std::vector<Case> invariance_cases() {
    return {window("invariance/window-even", "window in a uniform field", 1.5, 1000.0, 1000.0),
            window("invariance/window-uneven", "window with half the luminance on the near side",
                   1.7, 1000.0, 500.0),
            ball("invariance/ball-1.5", 1.5, 0.6), ball("invariance/ball-1.8", 1.8, 0.4)};
}

Case drawn_invariance(const std::string& id, Draw& draw) {
    const double index = draw.between(1.2, 2.2);
    if (draw.happens(0.5)) return ball(id, index, draw.between(0.1, 0.9), {});
    return window(id, "window between two luminances", index, draw.log_between(100.0, 1e4),
                  draw.log_between(100.0, 1e4), {});
}

}  // namespace lucerna::validation
