// Grids of points as a room is verified by: their mean, minimum, maximum, and the ratios of these.
#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "validation/cases.h"
#include "validation/cases/panel_room.h"
#include "validation/scene_builder.h"
#include "validation/truth/polygon_light.h"

namespace lucerna::validation {
namespace {

using namespace optics;

using Illuminance = std::function<double(const Vec3&)>;

// side x side points in the middles of the cells of a square on the floor.
std::vector<Vec3> grid(const Vec3& corner, double width_m, int side) {
    std::vector<Vec3> points;
    for (int j = 0; j < side; ++j) {
        for (int i = 0; i < side; ++i) {
            points.push_back(corner + width_m / side * Vec3(i + 0.5, j + 0.5, 0.0));
        }
    }
    return points;
}

// Checks of all that follows from the points, which are the first and only ones of the scene.
// @param truth_error  of each illuminance, in shares of it.
Case grid_case(const std::string& id, const std::string& title, const std::string& source,
               SceneBuilder scene, const std::vector<Vec3>& points, const Illuminance& illuminance,
               double truth_error, const optics::Settings& settings) {
    std::vector<double> values;
    double sum = 0.0;
    for (const Vec3& point : points) {
        values.push_back(illuminance(point));
        sum += values.back();
    }
    const double mean = sum / static_cast<double>(points.size());
    const auto [least, greatest] = std::ranges::minmax(values);
    scene.points(points, Vec3::UnitZ());
    const auto check = [&](const char* name, const char* quantity, const char* unit, double truth,
                           double error, std::size_t i) -> Check {
        return {name, quantity, unit, truth, error * truth, derived(i), 0.02};
    };
    return {id,
            title,
            source,
            std::move(scene.parts),
            settings,
            {check("mean", "average illuminance", "lx", mean, truth_error, 0),
             check("minimum", "minimum illuminance", "lx", least, truth_error, 1),
             check("maximum", "maximum illuminance", "lx", greatest, truth_error, 2),
             check("U0", "illuminance uniformity", "1", least / mean, 2.0 * truth_error, 3),
             check("Ud", "illuminance diversity", "1", least / greatest, 2.0 * truth_error, 4)}};
}

const Rectangle level_lamp{{-0.4, -0.5, 1.5}, {0.0, 1.0, 0.0}, {0.8, 0.0, 0.0}};

// Corners of the symmetric grid are equally dark, so that each may turn out the least.
Case below_rectangle(const std::string& id, const std::string& title, const Rectangle& lamp,
                     const Vec3& corner, int side, const optics::Settings& settings) {
    constexpr double luminance = 2000.0;  // cd/m2
    SceneBuilder scene;
    scene.area_light(scene.object("lamp", lamp, scene.black()), luminance);
    return grid_case(
        id, title, "Lambert's polygon formula at each point", std::move(scene),
        grid(corner, 2.0, side),
        [&](const Vec3& x) {
            return truth::polygon_illuminance(truth::corners(lamp.corner, lamp.edge_u, lamp.edge_v),
                                              luminance, x, Vec3::UnitZ());
        },
        0.0, settings);
}

// The mirrored light is read from photons, which neighbours share.
Case beside_mirror() {
    constexpr double intensity_cd = 100.0;
    constexpr double rho = 0.9;
    constexpr double mirror_x_m = 1.2;
    const Vec3 lamp(0.4, 0.0, 1.0);
    SceneBuilder scene;
    scene.object("floor", Rectangle{{-3, -4, 0}, {6, 0, 0}, {0, 8, 0}}, scene.black());
    scene.object("mirror", Rectangle{{mirror_x_m, -4, 0}, {0, 0, 4}, {0, 8, 0}}, scene.mirror(rho));
    scene.light("lamp", PointLight{lamp}, 4.0 * pi * intensity_cd);
    const auto from = [=](const Vec3& source, const Vec3& x) {
        const Vec3 way = source - x;
        return intensity_cd * way.z() / std::pow(way.norm(), 3);
    };
    const Vec3 image(2.0 * mirror_x_m - lamp.x(), lamp.y(), lamp.z());
    return grid_case(
        "grids/mirror", "4 x 4 points below a point source beside a mirror",
        "I cos / d2 from the source and its image", std::move(scene),
        grid({0.2, -0.3, 0.0}, 0.9, 4),
        [&](const Vec3& x) { return from(lamp, x) + rho * from(image, x); }, 0.0,
        effort(64, 20000));
}

// All light of the floor comes from the luminous half of the ceiling and from the other walls.
Case closed_box() {
    const std::vector<truth::Panel> panels{
        {0, 0.0, {0.0, 1.3}, {0.0, 0.8}, 0.3, 0.0},  {0, 1.0, {0.0, 1.3}, {0.0, 0.8}, 0.8, 0.0},
        {1, 0.0, {0.0, 0.8}, {0.0, 1.0}, 0.5, 0.0},  {1, 1.3, {0.0, 0.8}, {0.0, 1.0}, 0.1, 0.0},
        {2, 0.0, {0.0, 1.0}, {0.0, 1.3}, 0.65, 0.0}, {2, 0.8, {0.0, 1.0}, {0.0, 0.65}, 0.6, 100.0},
        {2, 0.8, {0.0, 1.0}, {0.65, 1.3}, 0.6, 0.0}};
    SceneBuilder scene;
    for (const truth::Panel& panel : panels) {
        const ObjectId wall =
            scene.object("panel", rectangle(panel), scene.diffuse(panel.reflectance));
        if (panel.emitted_luminance > 0.0) scene.area_light(wall, panel.emitted_luminance);
    }
    const truth::RoomRadiosity coarse(panels, 6), fine(panels, 12);
    return grid_case(
        "grids/closed_box", "4 x 4 points on the floor of a room of six reflectances",
        "radiosity integral equation, as closed_box", std::move(scene),
        grid({0.1, 0.2, lift_m}, 0.8, 4),
        [&](const Vec3& x) {
            return extrapolated(coarse, fine, [&](const truth::RoomRadiosity& room) {
                return room.illuminance(x, Vec3::UnitZ());
            });
        },
        radiosity_error, effort(96, 8000));
}

}  // namespace

std::vector<Case> grid_cases() {
    return {below_rectangle("grids/rectangle", "5 x 5 points beside a luminous rectangle",
                            level_lamp, {-0.3, -0.2, 0.0}, 5, effort(64, 100)),
            below_rectangle("grids/symmetric",
                            "4 x 4 points around the foot of a luminous rectangle: four are least",
                            level_lamp, {-1.0, -1.0, 0.0}, 4, effort(64, 100)),
            beside_mirror(), closed_box()};
}

Case drawn_grid(const std::string& id, Draw& draw) {
    const Rectangle lamp{
        {draw.between(-1.0, 1.0), draw.between(-1.0, 1.0), draw.log_between(0.5, 4.0)},
        {0.0, draw.log_between(0.05, 2.0), 0.0},
        {draw.log_between(0.05, 2.0), 0.0, 0.0}};
    const int side = static_cast<int>(draw.between(2.0, 8.0));
    return below_rectangle(id, fmt::format("{0} x {0} points below a luminous rectangle", side),
                           lamp, {draw.between(-1.5, -0.5), draw.between(-1.5, -0.5), 0.0}, side,
                           {});
}

}  // namespace lucerna::validation
