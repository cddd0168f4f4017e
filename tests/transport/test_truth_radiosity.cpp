// A room of seven diffuse panels, one of them a luminous half of the ceiling, against Galerkin
// radiosity with exchange factors in closed form.
#include "tests/support/truth_checks.h"
#include "validation/truth/polygon_light.h"
#include "validation/truth/room_radiosity.h"

using namespace lucerna;
using namespace lucerna::optics;
using truth::extrapolated;
using truth::Panel;
using truth::RoomRadiosity;
using validation::SceneBuilder;

namespace {

constexpr double x_m = 1.0, y_m = 1.3, z_m = 0.8;

const std::vector<Panel>& panels() {
    // Axes: x = 0, y = 1, z = 2; spans are those of the two axes that follow.
    static const std::vector<Panel> list{
        {0, 0.0, {0.0, y_m}, {0.0, z_m}, 0.3, 0.0},        // -x
        {0, x_m, {0.0, y_m}, {0.0, z_m}, 0.8, 0.0},        // +x
        {1, 0.0, {0.0, z_m}, {0.0, x_m}, 0.5, 0.0},        // -y
        {1, y_m, {0.0, z_m}, {0.0, x_m}, 0.1, 0.0},        // +y
        {2, 0.0, {0.0, x_m}, {0.0, y_m}, 0.65, 0.0},       // floor
        {2, z_m, {0.0, x_m}, {0.0, y_m / 2}, 0.6, 100.0},  // luminous half of the ceiling
        {2, z_m, {0.0, x_m}, {y_m / 2, y_m}, 0.75, 0.0}    // dark half of the ceiling
    };
    return list;
}

Vec3 inward_normal(const Panel& panel) {
    return (panel.plane_m == 0.0 ? 1.0 : -1.0) * Vec3::Unit(panel.axis);
}

double area_m2(const Panel& panel) {
    return (panel.span_u_m[1] - panel.span_u_m[0]) * (panel.span_v_m[1] - panel.span_v_m[0]);
}

Rectangle rectangle(const Panel& panel) {
    const int u = (panel.axis + 1) % 3;
    const int v = (panel.axis + 2) % 3;
    Vec3 corner = Vec3::Zero();
    corner[panel.axis] = panel.plane_m;
    corner[u] = panel.span_u_m[0];
    corner[v] = panel.span_v_m[0];
    const Vec3 edge_u = (panel.span_u_m[1] - panel.span_u_m[0]) * Vec3::Unit(u);
    const Vec3 edge_v = (panel.span_v_m[1] - panel.span_v_m[0]) * Vec3::Unit(v);
    if (panel.plane_m == 0.0) return {corner, edge_u, edge_v};
    return {corner, edge_v, edge_u};
}

struct Meter {
    std::size_t panel;
    Vec3 target;
    double half_angle_rad;
};
const Vec3 eye(0.5, 0.6, 0.4);
const std::vector<Meter> meters{
    {4, {0.6, 0.7, 0.0}, 0.5}, {0, {0.0, 0.8, 0.4}, 0.45}, {6, {0.5, 0.95, z_m}, 0.25}};

// Points close to walls, where a virtual sensor sees what the wall sees.
constexpr double lift_m = 1e-4;
const std::vector<std::pair<Vec3, Vec3>> points{{{0.3, 0.4, lift_m}, {0, 0, 1}},
                                                {{lift_m, 0.9, 0.5}, {1, 0, 0}},
                                                {{0.4, y_m - lift_m, 0.3}, {0, -1, 0}}};

// Without receivers paths for what is gathered where it is seen are split.
SceneBuilder room(bool receivers) {
    SceneBuilder scene;
    for (const Panel& panel : panels()) {
        const ObjectId wall =
            scene.object("wall", rectangle(panel), scene.diffuse(panel.reflectance));
        if (panel.emitted_luminance > 0.0) scene.area_light(wall, panel.emitted_luminance);
        if (receivers) scene.receiver(wall);
    }
    for (const Meter& meter : meters) scene.meter(eye, meter.target, meter.half_angle_rad);
    return scene;
}

}  // namespace

TEST_CASE("Radiosity: exchange factors close and the solution has converged", "[unit]") {
    // Against Lambert's formula, integrated over one of the rectangles by a fine midpoint sum.
    const Panel floor{2, 0.0, {0.1, 0.5}, {0.2, 0.9}, 0.0, 0.0};
    const Panel wall{0, 1.0, {0.3, 1.2}, {0.1, 0.7}, 0.0, 0.0};
    const auto polygon = truth::corners({1.0, 0.3, 0.1}, {0.0, 0.9, 0.0}, {0.0, 0.0, 0.6});
    constexpr int steps = 64;
    double sum = 0.0;
    for (int i = 0; i < steps; ++i) {
        for (int j = 0; j < steps; ++j) {
            const Vec3 x(0.1 + 0.4 * (i + 0.5) / steps, 0.2 + 0.7 * (j + 0.5) / steps, 0.0);
            sum += truth::polygon_illuminance(polygon, 1.0 / pi, x, Vec3::UnitZ());
        }
    }
    CHECK_THAT(truth::exchange_area_m2(floor, wall),
               Catch::Matchers::WithinRel(sum * 0.28 / (steps * steps), 1e-4));

    const RoomRadiosity room_6(panels(), 6), room_12(panels(), 12);
    const RoomRadiosity room_8(panels(), 8), room_16(panels(), 16);
    CHECK(room_16.closure_error() < 1e-10);
    const auto check_converged = [&](const auto& functional) {
        CHECK_THAT(extrapolated(room_6, room_12, functional),
                   Catch::Matchers::WithinRel(extrapolated(room_8, room_16, functional), 1e-4));
    };
    double absorbed = 0.0;
    double emitted = 0.0;
    for (std::size_t panel = 0; panel < panels().size(); ++panel) {
        const auto mean = [&](const RoomRadiosity& room) { return room.mean_illuminance(panel); };
        check_converged(mean);
        const Panel& own = panels()[panel];
        absorbed += (1.0 - own.reflectance) * area_m2(own) * extrapolated(room_8, room_16, mean);
        emitted += pi * own.emitted_luminance * area_m2(own);
    }
    CHECK_THAT(absorbed, Catch::Matchers::WithinRel(emitted, 1e-4));
    for (const auto& [position, normal] : points) {
        check_converged([&, x = position, up = normal](const RoomRadiosity& room) {
            return room.illuminance(x, up);
        });
    }
}

TEST_CASE("Radiosity: six different walls and half a luminous ceiling", "[analytic]") {
    static const RoomRadiosity coarse(panels(), 8), fine(panels(), 16);
    const auto [method, effort] =
        GENERATE(table<Method, test::Effort>({{Method::combined, {224, 16000}},
                                              {Method::forward, {96, 5000}},
                                              {Method::path, {128, 100}}}));
    INFO("method " << static_cast<int>(method));
    SceneBuilder scene = room(method == Method::combined);
    // A map gathered where it is seen needs many kernels in view, which a point does not offer.
    const bool narrow = method != Method::forward;
    if (narrow) {
        for (const auto& [position, normal] : points) scene.points({position}, normal);
    }
    const Result result = test::run(scene, method, effort);
    std::size_t next = 0;
    for (const Meter& meter : meters) {
        const Estimate& estimate = result.quantities[next++].estimate;
        if (method != Method::combined && meter.half_angle_rad < 0.5) continue;
        INFO("meter on wall " << meter.panel);
        const double value = extrapolated(coarse, fine, [&](const RoomRadiosity& truth) {
            return truth.cone_luminance(meter.panel, inward_normal(panels()[meter.panel]), eye,
                                        (meter.target - eye).normalized(), meter.half_angle_rad);
        });
        test::check_truth(estimate, value);
        test::check_refutes(estimate, 0.97 * value);
    }
    if (narrow) {
        for (const auto& [position, normal] : points) {
            const double value =
                extrapolated(coarse, fine, [&, x = position, up = normal](const RoomRadiosity& r) {
                    return r.illuminance(x, up);
                });
            const Estimate& estimate = result.quantities[next++].estimate;
            test::check_truth(estimate, value);
            test::check_refutes(estimate, value / pi);
        }
    }
    if (method != Method::combined) return;
    for (std::size_t panel = 0; panel < panels().size(); ++panel) {
        INFO("wall " << panel);
        const double mean = extrapolated(coarse, fine, [&](const RoomRadiosity& truth) {
            return truth.mean_illuminance(panel);
        });
        test::check_truth(result.quantities[next].estimate, mean * area_m2(panels()[panel]));
        CHECK(result.quantities[next + 1].estimate.mean() == 0.0);  // nothing behind the walls
        next += 2;
    }
}
