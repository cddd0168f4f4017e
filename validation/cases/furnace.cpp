// Closed furnaces: where every surface emits L_e and reflects rho, L = L_e + rho L in a uniform
// field, so that L = L_e / (1 - rho) everywhere in air, whatever the shapes, and E = pi L.
#include <fmt/format.h>

#include "validation/cases.h"
#include "validation/scene_builder.h"

namespace lucerna::validation {
namespace {

using namespace optics;

constexpr double emitted = 100.0;  // cd/m2
const std::string furnace_source =
    "L = Le / (1 - rho), E = pi L: energy balance of a uniform field (Kirchhoff's furnace)";

Placement turned() {
    Placement placement = Placement::Identity();
    placement.rotate(Eigen::AngleAxisd(0.7, Vec3(1.0, 2.0, -0.5).normalized()));
    return placement;
}

struct Look {
    std::string name;
    Vec3 from, at;
};

// The quantities are those of the observers in their order: meters, then points.
std::vector<Check> checks(double rho, const std::vector<Look>& looks, int points) {
    const double luminance = emitted / (1.0 - rho);
    std::vector<Check> list;
    for (const Look& look : looks) {
        list.push_back(
            {look.name, "luminance", "cd/m2", luminance, 0.0, sensor(list.size()), 0.01});
    }
    for (int i = 0; i < points; ++i) {
        list.push_back({fmt::format("point {}", i + 1), "illuminance", "lx", pi * luminance, 0.0,
                        sensor(list.size()), 0.01});
    }
    return list;
}

Case shell(const std::string& id, const std::string& title, const Shape& shape,
           const std::vector<Look>& looks, double rho = 0.7) {
    SceneBuilder scene;
    scene.area_light(scene.object("shell", shape, scene.diffuse(rho)), emitted, true);
    for (const Look& look : looks) scene.meter(look.from, look.at, 0.5);
    return {id, title, furnace_source, scene.parts, effort(64, 4000), checks(rho, looks, 0)};
}

Case room(const std::string& id, double rho, std::uint32_t phases, std::uint32_t rays) {
    SceneBuilder scene;
    for (const Shape& wall : SceneBuilder::room(1.0, 1.3, 0.8)) {
        scene.area_light(scene.object("wall", wall, scene.diffuse(rho)), emitted);
    }
    const Vec3 eye(0.5, 0.6, 0.4);
    const std::vector<Look> looks{{"wall", eye, {0.2, 0.0, 0.1}}, {"corner", eye, {0, 0, 0}}};
    for (const Look& look : looks) scene.meter(look.from, look.at, 0.4);
    scene.points({{0.3, 0.5, 0.3}}, Vec3(1.0, 2.0, 3.0).normalized());
    return {id,
            fmt::format("box room, all walls emit and reflect {:g}", rho),
            furnace_source,
            scene.parts,
            effort(phases, rays),
            checks(rho, looks, 1)};
}

}  // namespace

std::vector<Case> furnace_cases() {
    const Vec3 middle = turned() * Vec3(0.5, 0.6, 0.4);
    return {
        room("furnace/room-0.2", 0.2, 64, 1000),
        room("furnace/room-0.5", 0.5, 96, 2000),
        room("furnace/room-0.9", 0.9, 96, 4000),
        shell("furnace/box", "turned solid box, seen from within", Box{turned(), {1.0, 1.3, 0.8}},
              {{"face", middle, turned() * Vec3(1.0, 0.7, 0.3)},
               {"corner", middle, turned() * Vec3(1.0, 1.3, 0.8)}}),
        shell("furnace/sphere", "sphere, seen from within", Sphere{{0.1, 0.2, 0.3}, 0.6},
              {{"from the centre", {0.1, 0.2, 0.3}, {0.7, 0.2, 0.3}},
               {"from aside", {0.5, 0.3, 0.1}, {0.1, 0.8, 0.3}}}),
        shell("furnace/cylinder", "cylinder, seen from within",
              Cylinder{{0.0, 0.0, 0.0}, {0.4, 0.2, 1.0}, 0.4},
              {{"side", {0.2, 0.1, 0.5}, {0.6, 0.1, 0.5}},
               {"edge", {0.2, 0.1, 0.5}, {0.35, 0.0, 0.0}}}),
        shell("furnace/tube", "between the walls of a tube",
              Tube{{0.0, 0.0, 0.0}, {0.0, 0.3, 0.7}, 0.6, 0.2},
              {{"inner wall", {0.4, 0.15, 0.35}, {0.0, 0.15, 0.35}},
               {"outer wall", {0.4, 0.15, 0.35}, {0.4, 0.45, 0.35}}}),
    };
}

Case drawn_furnace(const std::string& id, Draw& draw) {
    const double rho = draw.between(0.1, 0.95);
    const Vec3 start(draw.between(-1.0, 1.0), draw.between(-1.0, 1.0), draw.between(-1.0, 1.0));
    const Vec3 axis = draw.direction(Vec3::UnitZ(), pi);
    const double radius_m = draw.log_between(0.05, 5.0);
    const double length_m = radius_m * draw.log_between(0.3, 5.0);
    // From a point on the axis or, in a tube, halfway between its walls, anywhere.
    const double hole = draw.between(0.2, 0.7);
    const int kind = static_cast<int>(draw.between(0.0, 4.0));
    const Vec3 aside = axis.unitOrthogonal();
    const Vec3 middle = start + 0.5 * length_m * axis;
    const auto looks = [&](const Vec3& from) {
        return std::vector<Look>{{"one way", from, from + draw.direction(axis, pi)},
                                 {"another way", from, from + draw.direction(axis, pi)}};
    };
    const auto title = [&](const char* shape) {
        return fmt::format("{} of {:.3g} m, reflectance {:.3f}, seen from within", shape, radius_m,
                           rho);
    };
    if (kind == 0) return shell(id, title("sphere"), Sphere{start, radius_m}, looks(start), rho);
    const Vec3 end = start + length_m * axis;
    if (kind == 1) {
        return shell(id, title("cylinder"), Cylinder{start, end, radius_m}, looks(middle), rho);
    }
    if (kind == 2) {
        const Vec3 from = middle + 0.5 * (1.0 + hole) * radius_m * aside;
        return shell(id, title("tube"), Tube{start, end, radius_m, hole * radius_m}, looks(from),
                     rho);
    }
    Placement place = Placement::Identity();
    place.translate(start);
    place.rotate(Eigen::Quaterniond::FromTwoVectors(Vec3::UnitZ(), axis));
    const Vec3 size(radius_m, hole * radius_m, length_m);
    return shell(id, title("box"), Box{place, size}, looks(place * Vec3(0.5 * size)), rho);
}

}  // namespace lucerna::validation
