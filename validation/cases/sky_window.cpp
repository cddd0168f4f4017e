// Uniform sky through an unglazed opening.
#include <fmt/format.h>

#include "validation/cases.h"
#include "validation/cases/panel_room.h"
#include "validation/truth/polygon_light.h"

namespace lucerna::validation {
namespace {

using namespace optics;

constexpr double sky =
    5000.0;  // A room 3 x 4 x 2.5 m with a strip window in the wall y = 0, across its whole width.
std::vector<NamedPanel> room(double rho) {
    return {{"wall -x", {0, 0.0, {0.0, 4.0}, {0.0, 2.5}, rho, 0.0}},
            {"wall +x", {0, 3.0, {0.0, 4.0}, {0.0, 2.5}, rho, 0.0}},
            {"below the window", {1, 0.0, {0.0, 0.9}, {0.0, 3.0}, rho, 0.0}, false},
            {"window", {1, 0.0, {0.9, 2.1}, {0.0, 3.0}, 0.0, sky}},
            {"above the window", {1, 0.0, {2.1, 2.5}, {0.0, 3.0}, rho, 0.0}, false},
            {"back wall", {1, 4.0, {0.0, 2.5}, {0.0, 3.0}, rho, 0.0}},
            {"floor", {2, 0.0, {0.0, 3.0}, {0.0, 4.0}, rho, 0.0}},
            {"ceiling", {2, 2.5, {0.0, 3.0}, {0.0, 4.0}, rho, 0.0}}};
}

// Walls that reflect nothing: the polygon formula of the window.
Case black_room() {
    const std::vector<NamedPanel> panels = room(0.0);
    SceneBuilder scene;
    const BsdfId black = scene.black();
    Rectangle opening{};
    for (const NamedPanel& own : panels) {
        if (own.name == "window") {
            opening = rectangle(own.panel);
        } else {
            scene.object(own.name, rectangle(own.panel), black);
        }
    }
    add_sky(scene, opening, sky);
    const auto polygon = truth::corners(opening.corner, opening.edge_u, opening.edge_v);
    std::vector<Check> checks;
    const auto add = [&](const std::string& name, const Vec3& x, const Vec3& normal) {
        checks.push_back({name, "illuminance", "lx",
                          truth::polygon_illuminance(polygon, sky, x, normal), 0.0,
                          sensor(checks.size()), 0.015});
        scene.points({x}, normal);
    };
    for (const double y : {0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5}) {
        add(fmt::format("desk, {:.1f} m from the window", y), {1.2, y, 0.8}, Vec3::UnitZ());
        checks.back().sweep = {"desk in a black room with a window", "distance [m]", y};
    }
    add("back wall", {1.2, 4.0 - lift_m, 1.3}, -Vec3::UnitY());
    return {"sky_window/black-room",
            "strip window of 3 x 1.2 m in a black room, sky of 5000 cd/m2",
            "Lambert's polygon formula of the opening (Photometria, 1760)",
            scene.parts,
            effort(256, 100),
            checks};
}

Case grey_room(double rho) {
    const std::vector<NamedPanel> panels = room(rho);
    const std::vector<WallPoint> points{{"desk near the window", {1.2, 1.0, 0.8}, {0, 0, 1}},
                                        {"desk in the depth", {1.2, 3.0, 0.8}, {0, 0, 1}},
                                        {"back wall", {1.2, 4.0 - lift_m, 1.3}, {0, -1, 0}}};
    Case own = room_case(fmt::format("sky_window/grey-room-{:g}", rho),
                         fmt::format("strip window in a room of reflectance {:g}", rho), panels,
                         points, effort(128, 24000));
    SceneBuilder scene{own.scene};
    add_sky(scene, rectangle(panels[3].panel), sky);
    own.scene = scene.parts;
    own.source += "; the opening stands for a black luminous panel";
    return own;
}

}  // namespace

std::vector<Case> sky_window_cases() {
    return {black_room(), grey_room(0.3), grey_room(0.6)};
}

}  // namespace lucerna::validation
