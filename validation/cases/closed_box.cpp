// Closed diffuse boxes of six reflectances, lit by a luminous half of the ceiling.
#include "validation/cases.h"
#include "validation/cases/panel_room.h"

namespace lucerna::validation {
namespace {

Case box(const std::string& id, const std::string& title, const Vec3& size,
         const std::array<double, 6>& rho, const optics::Settings& settings) {
    const double x = size.x(), y = size.y(), z = size.z();
    const std::vector<NamedPanel> panels{
        {"wall -x", {0, 0.0, {0.0, y}, {0.0, z}, rho[0], 0.0}},
        {"wall +x", {0, x, {0.0, y}, {0.0, z}, rho[1], 0.0}},
        {"wall -y", {1, 0.0, {0.0, z}, {0.0, x}, rho[2], 0.0}},
        {"wall +y", {1, y, {0.0, z}, {0.0, x}, rho[3], 0.0}},
        {"floor", {2, 0.0, {0.0, x}, {0.0, y}, rho[4], 0.0}},
        {"luminous half of ceiling", {2, z, {0.0, x}, {0.0, y / 2}, rho[5], 100.0}},
        {"dark half of ceiling", {2, z, {0.0, x}, {y / 2, y}, rho[5], 0.0}}};
    const std::vector<WallPoint> points{{"floor", {0.3 * x, 0.31 * y, lift_m}, {0, 0, 1}},
                                        {"wall -x", {lift_m, 0.7 * y, 0.6 * z}, {1, 0, 0}},
                                        {"wall +y", {0.4 * x, y - lift_m, 0.4 * z}, {0, -1, 0}}};
    return room_case(id, title, panels, points, settings);
}

}  // namespace

std::vector<Case> closed_box_cases() {
    return {box("closed_box/grey", "1 x 1.3 x 0.8 m, reflectances 0.1 to 0.8", {1.0, 1.3, 0.8},
                {0.3, 0.8, 0.5, 0.1, 0.65, 0.6}, effort(96, 12000)),
            box("closed_box/bright", "2 x 1 x 1 m, reflectances 0.5 to 0.9", {2.0, 1.0, 1.0},
                {0.9, 0.5, 0.85, 0.6, 0.7, 0.8}, effort(96, 8000))};
}

}  // namespace lucerna::validation
