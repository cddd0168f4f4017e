// Uniform sky through an unglazed opening.
#include <fmt/format.h>

#include "validation/cases.h"
#include "validation/cases/panel_room.h"
#include "validation/truth/polygon_light.h"

namespace lucerna::validation {
namespace {

using namespace optics;

constexpr double sky = 5000.0;

// A strip window in the wall y = 0, across the whole width of the room.
struct Room {
    double width_m = 3.0, depth_m = 4.0, height_m = 2.5;
    double sill_m = 0.9, head_m = 2.1;
};

std::vector<NamedPanel> panels_of(const Room& room, double rho) {
    const double x = room.width_m, y = room.depth_m, z = room.height_m;
    return {{"wall -x", {0, 0.0, {0.0, y}, {0.0, z}, rho, 0.0}},
            {"wall +x", {0, x, {0.0, y}, {0.0, z}, rho, 0.0}},
            {"below the window", {1, 0.0, {0.0, room.sill_m}, {0.0, x}, rho, 0.0}, false},
            {"window", {1, 0.0, {room.sill_m, room.head_m}, {0.0, x}, 0.0, sky}},
            {"above the window", {1, 0.0, {room.head_m, z}, {0.0, x}, rho, 0.0}, false},
            {"back wall", {1, y, {0.0, z}, {0.0, x}, rho, 0.0}},
            {"floor", {2, 0.0, {0.0, x}, {0.0, y}, rho, 0.0}},
            {"ceiling", {2, z, {0.0, x}, {0.0, y}, rho, 0.0}}};
}

// Walls that reflect nothing: the polygon formula of the window.
Case black_room() {
    const std::vector<NamedPanel> panels = panels_of({}, 0.0);
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

Case grey_room(const std::string& id, const Room& room, double rho,
               const optics::Settings& settings) {
    const std::vector<NamedPanel> panels = panels_of(room, rho);
    const double x = 0.4 * room.width_m, y = room.depth_m;
    const std::vector<WallPoint> points{
        {"desk near the window", {x, 0.25 * y, 0.8}, {0, 0, 1}},
        {"desk in the depth", {x, 0.75 * y, 0.8}, {0, 0, 1}},
        {"back wall", {x, y - lift_m, 0.52 * room.height_m}, {0, -1, 0}}};
    Case own = room_case(id, fmt::format("strip window in a room of reflectance {:g}", rho), panels,
                         points, settings);
    SceneBuilder scene{own.scene};
    add_sky(scene, rectangle(panels[3].panel), sky);
    own.scene = scene.parts;
    own.source += "; the opening stands for a black luminous panel";
    return own;
}

}  // namespace

std::vector<Case> sky_window_cases() {
    return {black_room(), grey_room("sky_window/grey-room-0.3", {}, 0.3, effort(128, 24000)),
            grey_room("sky_window/grey-room-0.6", {}, 0.6, effort(128, 24000))};
}

Case drawn_sky_window(const std::string& id, Draw& draw) {
    Room room{.width_m = draw.between(2.0, 8.0),
              .depth_m = draw.between(3.0, 10.0),
              .height_m = draw.between(2.4, 4.0)};
    room.sill_m = draw.between(0.4, 1.2);
    room.head_m = draw.between(room.sill_m + 0.5, room.height_m - 0.2);
    return grey_room(id, room, draw.between(0.1, 0.9), {});
}

}  // namespace lucerna::validation
