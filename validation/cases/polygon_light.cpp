// Lambertian rectangles over a floor, by Lambert's formula.
#include <fmt/format.h>

#include "validation/cases.h"
#include "validation/scene_builder.h"
#include "validation/truth/polygon_light.h"

namespace lucerna::validation {
namespace {

using namespace optics;

constexpr double luminance = 2000.0;  // cd/m2
const std::string polygon_source =
    "Lambert, Photometria, 1760, sections 138 to 143; as Arvo, thesis 1995, eq. 2.41";

Check illuminance(const std::string& name, const Rectangle& lamp, const Vec3& x, const Vec3& normal,
                  std::size_t i) {
    const double value = truth::polygon_illuminance(
        truth::corners(lamp.corner, lamp.edge_u, lamp.edge_v), luminance, x, normal);
    return {name, "illuminance", "lx", value, 0.0, sensor(i), 0.01};
}

// Along the floor, and the luminance of the floor at one of the points.
// @param points  of the floor; a meter sees the fifth.
Case over_a_floor(const std::string& id, const std::string& title, const Rectangle& lamp,
                  const std::vector<Vec3>& points, const optics::Settings& settings) {
    constexpr double rho = 0.4;
    SceneBuilder scene;
    scene.area_light(scene.object("lamp", lamp, scene.black()), luminance);
    scene.object("floor", Rectangle{{-5, -5, 0}, {10, 0, 0}, {0, 10, 0}}, scene.diffuse(rho));
    std::vector<Check> checks;
    for (const Vec3& point : points) {
        checks.push_back(illuminance(fmt::format("x = {:.1f} m", point.x()), lamp, point,
                                     Vec3::UnitZ(), checks.size()));
        checks.back().sweep = {id, "x [m]", point.x()};
    }
    scene.points(points, Vec3::UnitZ());
    scene.meter(points[4] + Vec3(-0.3, -0.1, 0.5), points[4], 0.001);
    const double value = rho / pi * checks[4].truth;
    // The cone is so narrow that the mean over it differs by less than 1e-5.
    checks.push_back({fmt::format("floor at x = {:.1f} m", points[4].x()), "luminance", "cd/m2",
                      value, 1e-5 * value, sensor(checks.size()), 0.01});
    return {id, title, polygon_source, scene.parts, settings, checks};
}

}  // namespace

std::vector<Case> polygon_light_cases() {
    const Rectangle level{{-0.3, -0.5, 1.5}, {0.0, 1.0, 0.0}, {0.8, 0.0, 0.0}};
    const Rectangle tilted{{-0.3, -0.5, 1.0}, {0.0, 1.0, 0.0}, {0.6, 0.0, 0.3}};
    // Points whose horizon cuts the rectangle.
    const Vec3 slanted = Vec3(1.0, 0.2, 0.5).normalized();
    const std::vector<Vec3> positions{{-1.5, 0.2, 0.8}, {0.2, 0.1, 1.1}};
    SceneBuilder scene;
    scene.area_light(scene.object("lamp", level, scene.black()), luminance);
    scene.points(positions, slanted);
    std::vector<Vec3> on_floor;
    for (const double x : {-2.0, -1.0, -0.5, 0.0, 0.5, 1.0, 2.0, 3.0}) {
        on_floor.emplace_back(x, 0.3, 0.0);
    }
    return {over_a_floor("polygon_light/level", "level rectangle, 0.8 x 1 m, 1.5 m up", level,
                         on_floor, effort(128, 100)),
            over_a_floor("polygon_light/tilted", "tilted rectangle, 0.67 x 1 m", tilted, on_floor,
                         effort(128, 100)),
            {"polygon_light/horizon",
             "rectangle partly behind the horizon of slanted sensors",
             polygon_source,
             scene.parts,
             effort(128, 100),
             {illuminance("from aside", level, positions[0], slanted, 0),
              illuminance("from below", level, positions[1], slanted, 1)}}};
}

Case drawn_polygon_light(const std::string& id, Draw& draw) {
    const Vec3 down = draw.direction(-Vec3::UnitZ(), 1.0);
    const Vec3 u = draw.log_between(0.05, 1.0) * down.unitOrthogonal();
    const Vec3 v = draw.log_between(0.05, 1.0) * down.cross(u).normalized();
    const Rectangle lamp{Vec3(0, 0, draw.between(1.5, 3.0)) - 0.5 * (u + v), u, v};
    const auto corners = truth::corners(lamp.corner, lamp.edge_u, lamp.edge_v);
    std::vector<Vec3> points;
    for (int i = 0; i < 8; ++i) {
        points.push_back(first_that(
            // In front of all of the lamp: where its plane is crossed the truth has an edge.
            [&](const Vec3& x) { return (x - corners[0]).dot(down) > 0.2; },
            [&] { return Vec3(draw.between(-3.5, 3.5), draw.between(-3.5, 3.5), 0.0); }));
    }
    return over_a_floor(id,
                        fmt::format("rectangle of {:.2f} x {:.2f} m, turned {:.0f} deg from level",
                                    u.norm(), v.norm(), std::acos(-down.z()) * 180.0 / pi),
                        lamp, points, {});
}

}  // namespace lucerna::validation
