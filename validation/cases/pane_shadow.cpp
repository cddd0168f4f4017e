// A sharp shadow behind glass: a point light, which no ray meets, so that all is read by kernels.
#include <fmt/format.h>

#include "validation/cases.h"
#include "validation/cases/pane_shadow.h"

namespace lucerna::validation {
namespace {

using namespace optics;

struct Point {
    double from_shadow_m, detects;
};

Case beside(const truth::PaneShadow& shadow, const std::string& id,
            const std::vector<Point>& points, const optics::Settings& settings) {
    SceneBuilder scene = pane_and_screen(shadow);
    Case result{.id = id,
                .title = fmt::format(
                    "beside the shadow of a screen {:g} m over the floor, lit by a "
                    "point through a pane of n = {:g}, {:g} mm",
                    shadow.screen_height_m, shadow.pane_index, 1e3 * shadow.pane_thickness_m),
                .source =
                    "E = sum of I T sin th / (x dx/dth) over orders of internal reflection, s and "
                    "p apart: Snell's law and conservation of flux",
                .scene = {},
                .settings = settings,
                .checks = {}};
    std::vector<Vec3> positions;
    for (const Point& point : points) {
        const double from_axis_m = shadow.shadow_edge_m() - point.from_shadow_m;
        positions.emplace_back(from_axis_m, 0.0, lift_m);
        const double value = shadow.illuminance_lx(from_axis_m);
        result.checks.push_back(
            {.name = fmt::format("{:g} mm beside it", 1e3 * point.from_shadow_m),
             .quantity = "illuminance",
             .unit = "lx",
             .truth = value,
             .truth_error = 1e-3 * value,  // lift of the points
             .read = sensor(result.checks.size()),
             .detects_relative = point.detects});
    }
    scene.points(std::move(positions), Vec3::UnitZ());
    result.scene = std::move(scene.parts);
    return result;
}

}  // namespace

std::vector<Case> pane_shadow_cases() {
    constexpr truth::PaneShadow low{.intensity_cd = 100.0,
                                    .lamp_height_m = 1.0,
                                    .pane_thickness_m = 0.01,
                                    .pane_index = 1.5,
                                    .screen_height_m = 0.1,
                                    .screen_edge_m = 0.2};
    truth::PaneShadow high = low;
    high.pane_thickness_m = 0.02;
    high.pane_index = 1.6;
    high.screen_height_m = 0.3;
    const std::vector<Point> points{
        {0.005, 0.3}, {0.01, 0.15}, {0.02, 0.1}, {0.05, 0.03}, {0.1, 0.02}};
    return {beside(low, "pane_shadow/low-screen", points, effort(64, 20000)),
            beside(high, "pane_shadow/high-screen", points, effort(64, 20000))};
}

// All within the floor before the screen, and lit by way of the pane.
Case drawn_pane_shadow(const std::string& id, Draw& draw) {
    const truth::PaneShadow shadow{.intensity_cd = 100.0,
                                   .lamp_height_m = draw.between(0.9, 1.4),
                                   .pane_thickness_m = draw.between(0.002, 0.04),
                                   .pane_index = draw.between(1.3, 1.8),
                                   .screen_height_m = draw.between(0.05, 0.4),
                                   .screen_edge_m = draw.between(0.1, 0.3)};
    std::vector<Point> points;
    for (int i = 0; i < 5; ++i) {
        const double furthest_m = shadow.shadow_edge_m() - 0.02;
        points.push_back({std::min(draw.log_between(0.005, 0.3), furthest_m), 0.02});
    }
    return beside(shadow, id, points, {});
}

}  // namespace lucerna::validation
