// A Cornell box without contents: flat reflectances, front open, a luminous strip in the ceiling.
#include <fmt/format.h>

#include "validation/cases.h"
#include "validation/cases/panel_room.h"

namespace lucerna::validation {
namespace {

Case cornell(const std::string& id, const std::string& title, double white, double left,
             double right, std::uint32_t rays) {
    // y is depth, z is up; the open front at y = 0 absorbs all that meets it.
    const double from = 0.35, to = 0.65;
    const std::vector<NamedPanel> panels{
        {"left wall", {0, 0.0, {0.0, 1.0}, {0.0, 1.0}, left, 0.0}},
        {"right wall", {0, 1.0, {0.0, 1.0}, {0.0, 1.0}, right, 0.0}},
        {"front", {1, 0.0, {0.0, 1.0}, {0.0, 1.0}, 0.0, 0.0}},
        {"back wall", {1, 1.0, {0.0, 1.0}, {0.0, 1.0}, white, 0.0}},
        {"floor", {2, 0.0, {0.0, 1.0}, {0.0, 1.0}, white, 0.0}},
        {"front of ceiling", {2, 1.0, {0.0, 1.0}, {0.0, from}, white, 0.0}, false},
        {"luminous strip", {2, 1.0, {0.0, 1.0}, {from, to}, white, 100.0}, false},
        {"back of ceiling", {2, 1.0, {0.0, 1.0}, {to, 1.0}, white, 0.0}, false}};
    std::vector<WallPoint> points;
    for (const double x : {0.1, 0.3, 0.5, 0.7, 0.9}) {
        points.push_back({fmt::format("floor, x = {:.1f} m", x), {x, 0.4, lift_m}, {0, 0, 1}});
    }
    points.push_back({"left wall", {lift_m, 0.6, 0.3}, {1, 0, 0}});
    points.push_back({"back wall", {0.25, 1.0 - lift_m, 0.4}, {0, -1, 0}});
    Case own = room_case(id, title, panels, points, effort(96, rays));
    for (std::size_t i = 0; i < 5; ++i) {
        own.checks[i].sweep = {fmt::format("floor of {}", id), "x [m]", points[i].position.x()};
    }
    return own;
}

}  // namespace

std::vector<Case> cornell_room_cases() {
    return {cornell("cornell_room/grey", "white 0.75, left wall 0.5, right wall 0.25", 0.75, 0.5,
                    0.25, 8000),
            cornell("cornell_room/dark", "white 0.4, left wall 0.1, right wall 0.6", 0.4, 0.1, 0.6,
                    14000)};
}

}  // namespace lucerna::validation
