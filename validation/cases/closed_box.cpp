// Closed diffuse boxes of six reflectances, lit by a luminous half of the ceiling.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "validation/cases.h"
#include "validation/cases/panel_room.h"

namespace lucerna::validation {
namespace {

std::vector<NamedPanel> panels_of(const Vec3& size, const std::array<double, 6>& rho,
                                  double luminous_share) {
    const double x = size.x(), y = size.y(), z = size.z();
    const double edge = luminous_share * y;
    return {{"wall -x", {0, 0.0, {0.0, y}, {0.0, z}, rho[0], 0.0}},
            {"wall +x", {0, x, {0.0, y}, {0.0, z}, rho[1], 0.0}},
            {"wall -y", {1, 0.0, {0.0, z}, {0.0, x}, rho[2], 0.0}},
            {"wall +y", {1, y, {0.0, z}, {0.0, x}, rho[3], 0.0}},
            {"floor", {2, 0.0, {0.0, x}, {0.0, y}, rho[4], 0.0}},
            {"luminous part of ceiling", {2, z, {0.0, x}, {0.0, edge}, rho[5], 100.0}},
            {"dark part of ceiling", {2, z, {0.0, x}, {edge, y}, rho[5], 0.0}}};
}

// @param points  in shares of the size.
Case box(const std::string& id, const std::string& title, const Vec3& size,
         const std::array<double, 6>& rho, double luminous_share,
         const std::vector<WallPoint>& points, const optics::Settings& settings) {
    std::vector<WallPoint> at = points;
    for (WallPoint& point : at) {
        point.position = point.position.cwiseProduct(size) + lift_m * point.normal;
    }
    return room_case(id, title, panels_of(size, rho, luminous_share), at, settings);
}

// Meters that see far more places than one gather stands for.
Case wide_spots(const std::string& id, const std::string& title, optics::Method method) {
    return spot_case(id, title, panels_of({1.0, 1.3, 0.8}, {0.3, 0.8, 0.5, 0.1, 0.65, 0.6}, 0.5),
                     {{"floor, cone of 57 deg", 4, {0.5, 0.6, 0.6}, {0.5, 0.7, 0.0}, 0.5},
                      {"wall +x, cone of 46 deg", 1, {0.3, 0.6, 0.4}, {1.0, 0.5, 0.4}, 0.4},
                      {"wall -y, cone of 11 deg", 2, {0.4, 1.2, 0.5}, {0.6, 0.0, 0.3}, 0.1}},
                     effort(64, 20000, 64, method));
}

}  // namespace

std::vector<Case> closed_box_cases() {
    const std::vector<WallPoint> points{{"floor", {0.3, 0.31, 0.0}, {0, 0, 1}},
                                        {"wall -x", {0.0, 0.7, 0.6}, {1, 0, 0}},
                                        {"wall +y", {0.4, 1.0, 0.4}, {0, -1, 0}}};
    return {box("closed_box/grey", "1 x 1.3 x 0.8 m, reflectances 0.1 to 0.8", {1.0, 1.3, 0.8},
                {0.3, 0.8, 0.5, 0.1, 0.65, 0.6}, 0.5, points, effort(96, 12000)),
            box("closed_box/bright", "2 x 1 x 1 m, reflectances 0.5 to 0.9", {2.0, 1.0, 1.0},
                {0.9, 0.5, 0.85, 0.6, 0.7, 0.8}, 0.5, points, effort(96, 8000)),
            wide_spots("closed_box/spots-gathered",
                       "meters of 11 to 57 degrees, indirect light gathered where they look",
                       optics::Method::forward),
            wide_spots("closed_box/spots-followed",
                       "the same meters, indirect light gathered one event later",
                       optics::Method::combined)};
}

Case drawn_closed_box(const std::string& id, Draw& draw) {
    const Vec3 size(draw.log_between(0.5, 2.0), draw.log_between(0.5, 2.0),
                    draw.log_between(0.5, 2.0));
    std::array<double, 6> rho{};
    for (double& of_wall : rho) of_wall = draw.between(0.05, 0.95);
    const double luminous_share = draw.between(0.3, 0.7);
    std::vector<WallPoint> points;
    for (const Vec3& normal : {Vec3(1, 0, 0), Vec3(0, -1, 0), Vec3(0, 0, 1)}) {
        Vec3 position(draw.between(0.1, 0.9), draw.between(0.1, 0.9), draw.between(0.1, 0.9));
        for (int axis = 0; axis < 3; ++axis) {
            if (normal[axis] != 0.0) position[axis] = normal[axis] > 0.0 ? 0.0 : 1.0;
        }
        points.push_back({fmt::format("point {}", points.size() + 1), position, normal});
    }
    return box(id,
               fmt::format("{:.2f} x {:.2f} x {:.2f} m, reflectances {:.2f}", size.x(), size.y(),
                           size.z(), fmt::join(rho, ", ")),
               size, rho, luminous_share, points, {});
}

}  // namespace lucerna::validation
