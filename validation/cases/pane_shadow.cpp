// A sharp shadow behind glass: a point light, which no ray meets, so that all is read by kernels.
#include "validation/truth/pane_shadow.h"

#include <fmt/format.h>

#include "validation/cases.h"
#include "validation/scene_builder.h"

namespace lucerna::validation {
namespace {

using namespace optics;

Case shadow(const std::string& id, const truth::PaneShadow& truth, double pane_height_m) {
    SceneBuilder scene;
    // The pane is so wide, and so near to the lamp, that light by way of its rim lands far away.
    constexpr double pane_m = 3.0;
    scene.object("floor", Rectangle{{-2, -2, 0}, {4, 0, 0}, {0, 4, 0}}, scene.black());
    scene.solid("pane",
                Box{Placement(Eigen::Translation3d(-0.5 * pane_m, -0.5 * pane_m, pane_height_m)),
                    {pane_m, pane_m, truth.pane_thickness_m}},
                scene.medium(truth.pane_index));
    scene.object(
        "screen",
        Rectangle{{truth.screen_edge_m, -1, truth.screen_height_m}, {0.6, 0, 0}, {0, 2, 0}},
        scene.black());
    scene.light("lamp", PointLight{{0, 0, truth.lamp_height_m}}, 4.0 * pi * truth.intensity_cd);
    Case result{
        .id = id,
        .title = fmt::format("beside the shadow of a screen {:g} m over the floor, lit by a "
                             "point through a pane of n = {:g}, {:g} mm",
                             truth.screen_height_m, truth.pane_index, 1e3 * truth.pane_thickness_m),
        .source =
            "E = sum of I T sin th / (x dx/dth) over orders of internal reflection, s and "
            "p apart: Snell's law and conservation of flux",
        .scene = {},
        .settings = effort(64, 20000),
        .checks = {}};
    struct Point {
        double from_shadow_m, detects;
    };
    std::vector<Vec3> positions;
    for (const Point& point :
         {Point{0.005, 0.3}, {0.01, 0.15}, {0.02, 0.1}, {0.05, 0.03}, {0.1, 0.02}}) {
        const double from_axis_m = truth.shadow_edge_m() - point.from_shadow_m;
        positions.emplace_back(from_axis_m, 0.0, lift_m);
        const double value = truth.illuminance_lx(from_axis_m);
        result.checks.push_back(
            {.name = fmt::format("{:g} mm beside it", 1e3 * point.from_shadow_m),
             .quantity = "illuminance",
             .unit = "lx",
             .truth = value,
             .truth_error = 1e-3 * value,  // lift of the points, screen's far edge
             .read = sensor(result.checks.size()),
             .detects_relative = point.detects});
    }
    scene.points(std::move(positions), Vec3::UnitZ());
    result.scene = std::move(scene.parts);
    return result;
}

}  // namespace

std::vector<Case> pane_shadow_cases() {
    return {shadow("pane_shadow/low-screen", {100.0, 1.0, 0.01, 1.5, 0.1, 0.2}, 0.7),
            shadow("pane_shadow/high-screen", {100.0, 1.0, 0.02, 1.6, 0.3, 0.2}, 0.7)};
}

}  // namespace lucerna::validation
