// After the daylight cases of CIE 171:2006. Geometry and numbers are our own; see cie171.cpp.
#include "validation/cases/cie171.h"
#include "validation/truth/sky_light.h"
#include "validation/truth/slab.h"

namespace lucerna::validation {
namespace {

using namespace optics;

struct Hole {
    double from_u, to_u, from_v, to_v;  ///< in the spans of the panel
};

// The four panels of a wall around a rectangular hole, and the hole.
struct Opened {
    std::array<truth::Panel, 4> around;
    truth::Panel hole;
};

Opened opened(truth::Panel wall, const Hole& hole) {
    const auto part = [&](double u0, double u1, double v0, double v1) {
        truth::Panel own = wall;
        own.span_u_m = {u0, u1};
        own.span_v_m = {v0, v1};
        return own;
    };
    const auto& u = wall.span_u_m;
    const auto& v = wall.span_v_m;
    return {{part(u[0], hole.from_u, v[0], v[1]), part(hole.to_u, u[1], v[0], v[1]),
             part(hole.from_u, hole.to_u, v[0], hole.from_v),
             part(hole.from_u, hole.to_u, hole.to_v, v[1])},
            part(hole.from_u, hole.to_u, hole.from_v, hole.to_v)};
}

// Black rooms of 4 x 4 x 3 m: walls -x, +x, -y, +y, floor, ceiling.
std::array<truth::Panel, 6> black_walls() {
    return {truth::Panel{0, 0.0, {0.0, 4.0}, {0.0, 3.0}, 0.0, 0.0},
            truth::Panel{0, 4.0, {0.0, 4.0}, {0.0, 3.0}, 0.0, 0.0},
            truth::Panel{1, 0.0, {0.0, 3.0}, {0.0, 4.0}, 0.0, 0.0},
            truth::Panel{1, 4.0, {0.0, 3.0}, {0.0, 4.0}, 0.0, 0.0},
            truth::Panel{2, 0.0, {0.0, 4.0}, {0.0, 4.0}, 0.0, 0.0},
            truth::Panel{2, 3.0, {0.0, 4.0}, {0.0, 4.0}, 0.0, 0.0}};
}

constexpr double sky = 1000.0 / pi;  // cd/m2: 1000 lx on an open level plane
const std::array<std::string, 6> wall_names{"wall -x", "wall +x", "wall -y",
                                            "wall +y", "floor",   "ceiling"};

// The room with a hole in one wall; returns the hole.
Rectangle room_with_hole(SceneBuilder& scene, std::size_t wall, const Hole& hole, bool receivers) {
    const auto walls = black_walls();
    const Opened parts = opened(walls[wall], hole);
    const BsdfId black = scene.black();
    for (const truth::Panel& part : parts.around) {
        scene.object("around the opening", rectangle(part), black);
    }
    for (std::size_t i = 0; i < walls.size(); ++i) {
        if (i == wall) continue;
        const ObjectId own = scene.object(wall_names[i], rectangle(walls[i]), black);
        if (receivers) scene.receiver(own);
    }
    return rectangle(parts.hole);
}

// The same with a uniform sky behind.
Rectangle opened_room(SceneBuilder& scene, std::size_t wall, const Hole& hole, bool receivers) {
    const Rectangle opening = room_with_hole(scene, wall, hole, receivers);
    add_sky(scene, opening, sky);
    return opening;
}

// 5.4: the flux through a roof opening is that on the surfaces within.
Case flux_conservation(double side_m) {
    const Hole hole{2.0 - side_m / 2, 2.0 + side_m / 2, 2.0 - side_m / 2, 2.0 + side_m / 2};
    SceneBuilder scene;
    const Rectangle opening = opened_room(scene, 5, hole, true);
    const ObjectId sheet = scene.object("opening", opening, pass_through);
    scene.receiver(sheet);
    const auto walls = black_walls();
    const truth::Panel sky_panel = opened(walls[5], hole).hole;
    std::vector<Check> checks;
    for (std::size_t i = 0; i < 5; ++i) {
        const double value = pi * sky * truth::exchange_area_m2(sky_panel, walls[i]);
        checks.push_back(
            {wall_names[i], "luminous flux", "lm", value, 1e-9 * value, sensor(2 * i), 0.01});
    }
    const double through = pi * sky * side_m * side_m;
    // Light meets the sheet from behind: its normal points into the room.
    checks.push_back(
        {"through the opening", "luminous flux", "lm", through, 0.0, sensor(11), 0.01});
    return {fmt::format("cie171/5.4-opening-{:g}", side_m),
            fmt::format("after 5.4: roof opening of {0:g} x {0:g} m, black room of 4 x 4 x 3 m",
                        side_m),
            "Phi = pi L A through the opening; its parts by exchange areas in closed form "
            "(Howell's catalogue, C-13 and C-15)",
            scene.parts,
            effort(64, 20000),
            checks};
}

// 5.5: beams through a clear pane, each under its own angle and over its own strip of floor.
Case directional_transmittance(double index, double absorption_per_m) {
    constexpr double thickness_m = 0.006, beam_m = 0.1, strip_m = 1.0, height_m = 0.5;
    const std::vector<double> angles_deg{0.0, 30.0, 45.0, 60.0, 75.0};
    const double width_m = static_cast<double>(angles_deg.size()) * strip_m;
    SceneBuilder scene;
    Placement place = Placement::Identity();
    place.translate(Vec3(-3.0, 0.0, 0.0));
    scene.solid("pane", Box{place, {6.0, width_m, thickness_m}},
                scene.medium(index, absorption_per_m));
    std::vector<Check> checks;
    for (std::size_t i = 0; i < angles_deg.size(); ++i) {
        const double angle_rad = angles_deg[i] * pi / 180.0;
        const Vec3 direction(std::sin(angle_rad), 0.0, -std::cos(angle_rad));
        const double from_m = static_cast<double>(i) * strip_m;
        const Vec3 middle = Vec3(0.0, from_m + 0.5 * strip_m, thickness_m) -
                            height_m / std::cos(angle_rad) * direction;
        scene.light("beam", BeamLight{Disk{middle, direction, beam_m}, direction}, lamp_flux_lm);
        scene.receiver(scene.object(
            "strip", Rectangle{{-3.0, from_m, -height_m}, {6.0, 0, 0}, {0, strip_m, 0}},
            scene.black()));
        const double value = lamp_flux_lm * truth::polarised_transmittance(
                                                index, angle_rad, absorption_per_m * thickness_m);
        checks.push_back(
            {.name = fmt::format("{:g} deg", angles_deg[i]),
             .quantity = "luminous flux",
             .unit = "lm",
             .truth = value,
             .truth_error = 1e-9 * value,
             .read = sensor(2 * i),
             .sweep = SweepPoint{fmt::format("flux through the pane of n = {:g}", index),
                                 "angle of incidence [deg]", angles_deg[i]}});
    }
    return {fmt::format("cie171/5.5-absorption-{:g}", absorption_per_m),
            fmt::format("after 5.5: beams through a pane of {:g} mm, n = {:g}, absorption {:g} /m",
                        1e3 * thickness_m, index, absorption_per_m),
            "Fresnel with s and p apart, (1 - R)^2 a / (1 - R^2 a^2), a = exp(-alpha d / cos th')",
            scene.parts,
            effort(64, 20000),
            checks};
}

// 5.9 and 5.11: sky component of a uniform sky through unglazed openings; points face up or stand
// where they see only the opening.
Case sky_component(const std::string& id, const std::string& title, std::size_t wall,
                   const Hole& hole, const std::vector<WallPoint>& places, bool facade) {
    SceneBuilder scene;
    const Rectangle opening = opened_room(scene, wall, hole, false);
    Points points{scene};
    for (const WallPoint& place : places) {
        std::optional<SweepPoint> sweep;
        if (place.normal.z() > 0.0) {
            sweep = SweepPoint{id, facade ? "y [m]" : "x [m]",
                               facade ? place.position.y() : place.position.x()};
        }
        points.add(
            place.name, place.position, place.normal,
            truth::polygon_illuminance(polygon_of(opening), sky, place.position, place.normal),
            sweep);
    }
    return {id,
            title,
            facade ? "Lambert's polygon formula of the opening; sky component only, no ground "
                     "outside. Tables of 5.11 are corrected in Ashdown's errata and not used"
                   : "Lambert's polygon formula of the opening",
            scene.parts,
            effort(256, 100),
            points.checks};
}

// A sky of the engine, and the same by its parameters.
template <typename TruthSky>
struct SkyPair {
    Sky engine;
    TruthSky truth;
};

// The same rectangle with an upright edge second, if it has one: the truth wants that.
Rectangle upright_second(const Rectangle& r) {
    return r.edge_u.z() != 0.0 ? Rectangle{r.corner, r.edge_v, r.edge_u} : r;
}

// Of an opening of the room.
Vec3 outward(const Rectangle& opening) {
    const Vec3 normal = opening.edge_u.cross(opening.edge_v).normalized();
    return (Vec3(2.0, 2.0, 1.5) - opening.corner).dot(normal) < 0.0 ? normal : Vec3(-normal);
}

void add_general_sky(SceneBuilder& scene, const Rectangle& opening, const Sky& sky,
                     double horizontal_lx, double ground) {
    const Vec3 normal = opening.edge_u.cross(opening.edge_v).normalized();
    const Vec3 inward = -outward(opening);
    const auto view = std::make_shared<const SkyView>(sky, inward, ground);
    scene.light("sky",
                AreaLight{scene.object("opening", opening, pass_through), opening, false,
                          inward.dot(normal) < 0.0, view},
                horizontal_lx / sky.horizontal_sr() * view->exitance_sr() * area_m2(opening));
}

// 5.9 and 5.11 with skies that are not uniform, and a ground.
template <typename TruthSky>
Case general_sky(const std::string& id, const std::string& title, std::size_t wall,
                 const Hole& hole, const std::vector<WallPoint>& places,
                 const SkyPair<TruthSky>& skies) {
    constexpr double horizontal_lx = 10000.0, ground = 0.2;
    SceneBuilder scene;
    const Rectangle opening = upright_second(room_with_hole(scene, wall, hole, false));
    add_general_sky(scene, opening, skies.engine, horizontal_lx, ground);
    Points points{scene};
    for (const WallPoint& place : places) {
        points.add(
            place.name, place.position, place.normal,
            truth::sky_illuminance(skies.truth, horizontal_lx, ground, opening.corner,
                                   opening.edge_u, opening.edge_v, place.position, place.normal));
        points.checks.back().truth_error = 1e-4 * points.checks.back().truth;
    }
    return {id,
            title,
            "E = int L cos cos' / r^2 dA over the opening by Gauss-Legendre quadrature, L of ISO "
            "15469 scaled by its integral over the sky",
            scene.parts,
            effort(256, 100),
            points.checks};
}

std::vector<Case> general_sky_cases() {
    const Vec3 up = Vec3::UnitZ();
    const Vec3 sun = Vec3(0.3, -0.8, 0.9).normalized();
    const auto general = [&](int type, double a, double b, double c, double d, double e) {
        return SkyPair<truth::StandardSky>{Sky::general(type, up, sun), {a, b, c, d, e, sun}};
    };
    const SkyPair<truth::OvercastSky> overcast{Sky::overcast(up), {}};
    const Hole roof{1.5, 2.5, 1.5, 2.5};
    const Hole window{1.0, 2.0, 1.0, 3.0};
    std::vector<WallPoint> roof_places;
    for (const double x : {0.25, 1.0, 1.75}) {
        roof_places.push_back(
            {fmt::format("floor, x = {:g} m", x), {x, 2.5, lift_m}, Vec3::UnitZ()});
    }
    roof_places.push_back({"wall -y", {2.0, lift_m, 1.0}, Vec3::UnitY()});
    roof_places.push_back({"wall +y", {2.0, 4.0 - lift_m, 1.0}, -Vec3::UnitY()});
    std::vector<WallPoint> window_places;
    for (const double y : {0.5, 1.5, 3.0}) {
        window_places.push_back(
            {fmt::format("floor, y = {:g} m", y), {2.0, y, lift_m}, Vec3::UnitZ()});
    }
    // The back wall sees sky and ground, the ceiling the ground alone.
    window_places.push_back({"back wall", {1.0, 4.0 - lift_m, 1.4}, -Vec3::UnitY()});
    window_places.push_back({"ceiling", {2.0, 1.0, 3.0 - lift_m}, -Vec3::UnitZ()});
    const std::string of_roof = "after 5.9: roof opening of 1 x 1 m, ";
    const std::string of_window = "after 5.11: window of 2 x 1 m over a ground of 20 %, ";
    return {general_sky("cie171/5.9-overcast", of_roof + "overcast sky", 5, roof, roof_places,
                        overcast),
            general_sky("cie171/5.9-type-12", of_roof + "clear sky, type 12", 5, roof, roof_places,
                        general(12, -1.0, -0.32, 10.0, -3.0, 0.45)),
            general_sky("cie171/5.11-type-1", of_window + "overcast sky, type 1", 2, window,
                        window_places, general(1, 4.0, -0.70, 0.0, -1.0, 0.0)),
            general_sky("cie171/5.11-type-8", of_window + "partly cloudy sky, type 8", 2, window,
                        window_places, general(8, 0.0, -1.0, 10.0, -3.0, 0.45)),
            general_sky("cie171/5.11-type-14", of_window + "cloudless sky, type 14", 2, window,
                        window_places, general(14, -1.0, -0.15, 16.0, -3.0, 0.30))};
}

std::vector<WallPoint> below_roof() {
    std::vector<WallPoint> places;
    for (const double x : {0.25, 0.75, 1.25, 1.75}) {
        places.push_back({fmt::format("floor, x = {:g} m", x), {x, 2.0, lift_m}, Vec3::UnitZ()});
    }
    for (const double z : {0.75, 1.75}) {
        places.push_back({fmt::format("wall, z = {:g} m", z), {lift_m, 2.0, z}, Vec3::UnitX()});
    }
    return places;
}

std::vector<WallPoint> before_facade() {
    std::vector<WallPoint> places;
    for (const double y : {0.5, 1.0, 1.5, 2.0, 3.0}) {
        places.push_back({fmt::format("floor, y = {:g} m", y), {2.0, y, lift_m}, Vec3::UnitZ()});
    }
    return places;
}

// A dielectric of n = 1.52 that absorbs 10 1/m, 6 mm thick: 6 % of the light in it.
constexpr double glass_index = 1.52, glass_absorption_per_m = 10.0, glass_m = 0.006;

// 5.10 and 5.12: a pane of glass before the opening, outside and wider than it, and the sky beyond.
// A parallel pane only shifts a ray, so that a direction that a point sees through the opening is
// that of the sky that it sees, weakened by the transmittance of the pane.
template <typename TruthSky>
Case glazed(const std::string& id, const std::string& title, std::size_t wall, const Hole& hole,
            const std::vector<WallPoint>& places, const SkyPair<TruthSky>& skies) {
    constexpr double horizontal_lx = 10000.0, ground = 0.2;
    SceneBuilder scene;
    const Rectangle opening = upright_second(room_with_hole(scene, wall, hole, false));
    const Vec3 out = outward(opening);
    const auto beyond = [&](double distance_m, double margin_m) {
        const Vec3 u = opening.edge_u.normalized(), v = opening.edge_v.normalized();
        return Rectangle{opening.corner + distance_m * out - margin_m * (u + v),
                         opening.edge_u + 2.0 * margin_m * u, opening.edge_v + 2.0 * margin_m * v};
    };
    const Rectangle near = beyond(0.001, 0.1);
    const Vec3 diagonal = near.edge_u + near.edge_v + glass_m * out;
    scene.solid(
        "pane",
        Box{Placement(Eigen::Translation3d(near.corner + 0.5 * (diagonal - diagonal.cwiseAbs()))),
            diagonal.cwiseAbs()},
        scene.medium(glass_index, glass_absorption_per_m));
    // Seen through the opening under 80 deg still.
    add_general_sky(scene, beyond(0.01, 0.2), skies.engine, horizontal_lx, ground);
    Points points{scene};
    for (const WallPoint& place : places) {
        points.add(place.name, place.position, place.normal,
                   truth::sky_illuminance(
                       skies.truth, horizontal_lx, ground, opening.corner, opening.edge_u,
                       opening.edge_v, place.position, place.normal, [&](const Vec3& w) {
                           return truth::polarised_transmittance(
                               glass_index, std::acos(std::min(1.0, std::abs(w.dot(out)))),
                               glass_absorption_per_m * glass_m);
                       }));
        points.checks.back().truth_error = 1e-4 * points.checks.back().truth;
    }
    return {id,
            title,
            "E = int T L cos cos' / r^2 dA over the opening by Gauss-Legendre quadrature, T of the "
            "pane with s and p apart and all internal reflections",
            scene.parts,
            effort(256, 2000),
            points.checks};
}

constexpr double mask_reflectance = 0.5;

// 5.13 and 5.14: something stands outside, seen from the room beside the sky, which lies beyond the
// opening `beyond`; its light on what stands there, which is diffuse, enters the room as well.
struct Obstruction {
    Rectangle mask;    ///< edge_u along x, as wide as `beyond`
    Rectangle beyond;  ///< the same
    bool overhang;     ///< the mask lies level above the window, else upright before it
};

template <typename TruthSky>
Case obstructed(const std::string& id, const std::string& title, const Hole& hole,
                const std::vector<WallPoint>& places, const Obstruction& outside,
                const SkyPair<TruthSky>& skies) {
    constexpr double horizontal_lx = 10000.0, ground = 0.3;
    SceneBuilder scene;
    const Rectangle opening = upright_second(room_with_hole(scene, 2, hole, false));
    scene.object("mask", outside.mask, scene.diffuse(mask_reflectance));
    add_general_sky(scene, outside.beyond, skies.engine, horizontal_lx, ground);
    const double scale = horizontal_lx / truth::horizontal_illuminance(skies.truth);
    const auto open_luminance = [&](const Vec3& w) {
        return w.z() > 0.0 ? scale * skies.truth.luminance(w) : ground * horizontal_lx / pi;
    };
    // From below an overhang only the ground is seen, and the sky before a wall is even.
    const Vec3 mask_normal = outside.overhang ? Vec3(-Vec3::UnitZ()) : Vec3(Vec3::UnitY());
    const double lights_mask = open_luminance(outside.overhang ? mask_normal : Vec3(Vec3::UnitZ()));
    const auto mask_luminance = [&](const Vec3& x) {
        return mask_reflectance / pi *
               truth::polygon_illuminance(polygon_of(outside.beyond), lights_mask, x, mask_normal);
    };
    const double front_y_m = outside.mask.corner.y();
    const double top_z_m = outside.mask.corner.z() + outside.mask.edge_v.z();
    Points points{scene};
    for (const WallPoint& place : places) {
        const Vec3& x = place.position;
        // Where a ray meets the plane of the mask, and whether it then meets the mask.
        const auto seen = [&](const Vec3& w) {
            const double t =
                outside.overhang ? (top_z_m - x.z()) / w.z() : (front_y_m - x.y()) / w.y();
            const Vec3 at = x + t * w;
            const bool met = outside.overhang ? t > 0.0 && at.y() > front_y_m : at.z() < top_z_m;
            return met ? mask_luminance(at) : open_luminance(w);
        };
        // The edge of the mask is a level line in the opening, and so is the horizon.
        const double edge_z = x.z() + (top_z_m - x.z()) * x.y() / (x.y() - front_y_m);
        const auto fraction = [&](double z) {
            return (z - opening.corner.z()) / opening.edge_v.z();
        };
        points.add(
            place.name, x, place.normal,
            truth::illuminance_through(seen, opening.corner, opening.edge_u, opening.edge_v,
                                       {fraction(edge_z), fraction(x.z())}, x, place.normal));
        points.checks.back().truth_error = 2e-4 * points.checks.back().truth;
    }
    return {
        id,
        title,
        "E = int L cos cos' / r^2 dA over the window by Gauss-Legendre quadrature, L of the "
        "sky, of the ground, or rho E / pi of what stands there, E by Lambert's polygon formula",
        scene.parts,
        effort(384, 10000),
        points.checks};
}

std::vector<Case> glazed_and_obstructed_cases() {
    const Vec3 up = Vec3::UnitZ();
    const SkyPair<truth::OvercastSky> overcast{Sky::overcast(up), {}};
    const SkyPair<truth::StandardSky> even{Sky::general(5, up, up),
                                           {0.0, -1.0, 0.0, -1.0, 0.0, up}};
    const Hole roof{1.5, 2.5, 1.5, 2.5};
    const Hole window{1.0, 2.0, 1.0, 3.0};
    std::vector<WallPoint> in_the_room;
    for (const double y : {0.5, 1.0, 2.0, 3.0}) {
        in_the_room.push_back(
            {fmt::format("floor, y = {:g} m", y), {2.0, y, lift_m}, Vec3::UnitZ()});
    }
    in_the_room.push_back({"back wall", {1.0, 4.0 - lift_m, 1.4}, -Vec3::UnitY()});
    // Outside the facade at y = 0, 20 m wide.
    const auto overhang = [](double depth_m) {
        return Obstruction{{{-8.0, -depth_m, 2.0}, {20.0, 0, 0}, {0, depth_m, 0}},
                           {{-8.0, -depth_m, -3.0}, {20.0, 0, 0}, {0, 0, 5.0}},
                           true};
    };
    const auto wall = [](double distance_m, double top_m) {
        return Obstruction{{{-18.0, -distance_m, -1.0}, {40.0, 0, 0}, {0, 0, top_m + 1.0}},
                           {{-18.0, -distance_m, top_m}, {40.0, 0, 0}, {0, distance_m, 0}},
                           false};
    };
    return {
        glazed("cie171/5.10-overcast", "after 5.10: 5.9 with a pane of 6 mm, overcast sky", 5, roof,
               below_roof(), overcast),
        glazed("cie171/5.12-overcast",
               "after 5.12: 5.11 with a pane of 6 mm, overcast sky, ground of 20 %", 2, window,
               before_facade(), overcast),
        obstructed("cie171/5.13-depth-1", "after 5.13: 5.11 under an overhang of 1 m, overcast sky",
                   window, in_the_room, overhang(1.0), overcast),
        obstructed("cie171/5.13-depth-2", "after 5.13: 5.11 under an overhang of 2 m, overcast sky",
                   window, in_the_room, overhang(2.0), overcast),
        obstructed("cie171/5.14-height-3",
                   "after 5.14: 5.11 before a wall 6 m away, 3 m high, even sky", window,
                   in_the_room, wall(6.0, 3.0), even),
        obstructed("cie171/5.14-height-6",
                   "after 5.14: 5.11 before a wall 6 m away, 6 m high, even sky", window,
                   in_the_room, wall(6.0, 6.0), even)};
}

}  // namespace

std::vector<Case> cie171_daylight_cases() {
    std::vector<Case> cases{
        flux_conservation(1.0),
        flux_conservation(3.0),
        directional_transmittance(1.52, 0.0),
        directional_transmittance(1.52, 30.0),
        sky_component("cie171/5.9-1x1", "after 5.9: roof opening of 1 x 1 m, 4 x 4 x 3 m", 5,
                      {1.5, 2.5, 1.5, 2.5}, below_roof(), false),
        sky_component("cie171/5.9-3x3", "after 5.9: roof opening of 3 x 3 m, 4 x 4 x 3 m", 5,
                      {0.5, 3.5, 0.5, 3.5}, below_roof(), false),
        // The spans of the facade are z and x.
        sky_component("cie171/5.11-2x1", "after 5.11: window of 2 x 1 m, 1 m above the floor", 2,
                      {1.0, 2.0, 1.0, 3.0}, before_facade(), true),
        sky_component("cie171/5.11-3x2", "after 5.11: window of 3 x 2 m, 0.5 m above the floor", 2,
                      {0.5, 2.5, 0.5, 3.5}, before_facade(), true),
    };
    for (Case& each : general_sky_cases()) cases.push_back(std::move(each));
    for (Case& each : glazed_and_obstructed_cases()) cases.push_back(std::move(each));
    return cases;
}

}  // namespace lucerna::validation
