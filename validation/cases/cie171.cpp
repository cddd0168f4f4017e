// After test cases of CIE 171:2006 that have an analytic truth. Geometry and numbers are our own,
// stated in each case: the tables of the document are not used, because some are known to be wrong
// (I. Ashdown, errata at lightinganalysts.com/cie-1712006-errata: Table 19 of 5.7, 5.8, 5.11). All
// truths are derived here from form factors and balances of flux.
#include <fmt/format.h>

#include "validation/cases.h"
#include "validation/cases/panel_room.h"
#include "validation/truth/polygon_light.h"
#include "validation/truth/sky_light.h"

namespace lucerna::validation {
namespace {

using namespace optics;

std::vector<Vec3> polygon_of(const Rectangle& r) {
    return truth::corners(r.corner, r.edge_u, r.edge_v);
}

// Collects points with their illuminances.
struct Points {
    SceneBuilder& scene;
    std::vector<Check> checks{};

    void add(const std::string& name, const Vec3& x, const Vec3& normal, double illuminance,
             std::optional<SweepPoint> sweep = std::nullopt) {
        checks.push_back({name, "illuminance", "lx", illuminance, 0.0, sensor(checks.size()), 0.015,
                          std::move(sweep)});
        scene.points({x}, normal);
    }
};

// 5.2: an isotropic source of 10000 cd in the middle of a black room of 4 x 4 x 3 m, at 3 m.
Case point_source(double height_m) {
    constexpr double intensity = 10000.0;
    SceneBuilder scene;
    const Vec3 lamp(2.0, 2.0, height_m);
    scene.light("lamp", PointLight{lamp}, 4.0 * pi * intensity);
    scene.object("floor", Rectangle{Vec3::Zero(), {4, 0, 0}, {0, 4, 0}}, scene.black());
    Points points{scene};
    for (const double x : {0.0, 0.5, 1.0, 1.5, 2.0}) {
        const Vec3 at(x, x, 0.0);
        const Vec3 way = lamp - at;
        points.add(fmt::format("diagonal, x = {:.1f} m", x), at, Vec3::UnitZ(),
                   intensity * way.z() / std::pow(way.norm(), 3));
    }
    const Vec3 wall(lift_m, 2.0, 1.0);
    const Vec3 way = lamp - wall;
    points.add("wall", wall, Vec3::UnitX(), intensity * way.x() / std::pow(way.norm(), 3));
    return {fmt::format("cie171/5.2-height-{:g}", height_m),
            fmt::format("after 5.2: isotropic source of 10000 cd, {:g} m over 4 x 4 m", height_m),
            "E = I cos/d^2",
            scene.parts,
            effort(32, 100),
            points.checks};
}

// 5.3: a Lambertian square of 1 x 1 m under the ceiling of a black room of 4 x 4 x 3 m.
Case area_source(double side_m) {
    constexpr double luminance = 3000.0;
    SceneBuilder scene;
    const Rectangle lamp{{2.0 - side_m / 2, 2.0 - side_m / 2, 3.0}, {0, side_m, 0}, {side_m, 0, 0}};
    scene.area_light(scene.object("lamp", lamp, scene.black()), luminance);
    scene.object("floor", Rectangle{Vec3::Zero(), {4, 0, 0}, {0, 4, 0}}, scene.black());
    Points points{scene};
    const auto add = [&](const std::string& name, const Vec3& x, const Vec3& normal) {
        points.add(name, x, normal,
                   truth::polygon_illuminance(polygon_of(lamp), luminance, x, normal));
    };
    for (const double x : {0.0, 0.5, 1.0, 1.5, 2.0}) {
        add(fmt::format("diagonal, x = {:.1f} m", x), {x, x, 0.0}, Vec3::UnitZ());
    }
    add("wall", {lift_m, 2.0, 1.5}, Vec3::UnitX());
    return {fmt::format("cie171/5.3-side-{:g}", side_m),
            fmt::format("after 5.3: Lambertian square of {:g} m, 3 m over 4 x 4 m", side_m),
            "Lambert's polygon formula",
            scene.parts,
            effort(128, 100),
            points.checks};
}

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

// A square S1 in the plane x = 0, lit evenly, reflects diffusely to the plane z = 0.
constexpr double lit_lx = 1000.0;
constexpr double bottom_m = 0.2;

Rectangle lit_square() {
    return {{0.0, -1.0, bottom_m}, {0, 2.0, 0}, {0, 0, 2.0}};  // faces +x
}

void light_evenly(SceneBuilder& scene, const Rectangle& square, double rho) {
    scene.object("lit square", square, scene.diffuse(rho));
    // A beam from close by: nothing that stands before the square is in its way.
    const Rectangle start{square.corner + 0.4 * Vec3::UnitX(), square.edge_v, square.edge_u};
    const double area_m2 = square.edge_u.norm() * square.edge_v.norm();
    scene.light("beam", BeamLight{start, -Vec3::UnitX()}, lit_lx * area_m2);
}

// 5.6: diffuse reflection.
Case diffuse_reflection(double rho) {
    SceneBuilder scene;
    const Rectangle square = lit_square();
    light_evenly(scene, square, rho);
    Points points{scene};
    const double luminance = rho / pi * lit_lx;
    for (const double x : {0.25, 0.5, 0.75, 1.0, 1.5, 2.0}) {
        const Vec3 at(x, 0.2, 0.0);
        points.add(
            fmt::format("x = {:g} m", x), at, Vec3::UnitZ(),
            truth::polygon_illuminance(polygon_of(square), luminance, at, Vec3::UnitZ()),
            SweepPoint{fmt::format("after CIE 171, 5.6, reflectance {:g}", rho), "x [m]", x});
    }
    return {
        fmt::format("cie171/5.6-{:g}", rho),
        fmt::format("after 5.6: lit square of 2 x 2 m of reflectance {:g}, floor before it", rho),
        "E = rho E1 F, F by Lambert's polygon formula",
        scene.parts,
        effort(384, 3000),
        points.checks};
}

// 5.7: the same with an obstruction parallel to the square. Seen from a point, it hides of the
// square's plane a rectangle: itself, seen from there in perspective.
Case obstruction(double height_m) {
    constexpr double rho = 0.8, obstruction_x_m = 0.5;
    SceneBuilder scene;
    const Rectangle square = lit_square();
    light_evenly(scene, square, rho);
    const double half_width_m = 0.3;
    scene.object(
        "obstruction",
        Rectangle{
            {obstruction_x_m, -half_width_m, 0.0}, {0, 2 * half_width_m, 0}, {0, 0, height_m}},
        scene.black());
    Points points{scene};
    const double luminance = rho / pi * lit_lx;
    for (const double x : {0.75, 1.0, 1.25, 1.5}) {
        const Vec3 at(x, 0.1, 0.0);
        const double scale = x / (x - obstruction_x_m);
        const double y0 = std::clamp(at.y() + scale * (-half_width_m - at.y()), -1.0, 1.0);
        const double y1 = std::clamp(at.y() + scale * (half_width_m - at.y()), -1.0, 1.0);
        const double z1 = std::clamp(scale * height_m, bottom_m, bottom_m + 2.0);
        const Rectangle hidden{{0.0, y0, bottom_m}, {0, y1 - y0, 0}, {0, 0, z1 - bottom_m}};
        const auto illuminance = [&](const Rectangle& r) {
            return truth::polygon_illuminance(polygon_of(r), luminance, at, Vec3::UnitZ());
        };
        points.add(fmt::format("x = {:g} m", x), at, Vec3::UnitZ(),
                   illuminance(square) - illuminance(hidden));
    }
    return {fmt::format("cie171/5.7-height-{:g}", height_m),
            fmt::format("after 5.7: 5.6 with a black sheet of 0.6 x {:g} m before the square",
                        height_m),
            "difference of polygon formulas of the square and of its hidden part; Table 19 of the "
            "document is wrong (Ashdown's errata) and not used",
            scene.parts,
            effort(384, 3000),
            points.checks};
}

// 5.8: a source in the middle of a closed cube of one reflectance. What is received is absorbed but
// for its share rho: (1 - rho) A E = Phi, and all faces are alike.
Case internally_reflected(double rho, std::uint32_t rays) {
    constexpr double flux_lm = 10000.0, side_m = 4.0;
    SceneBuilder scene;
    const BsdfId paint = scene.diffuse(rho);
    const auto faces = SceneBuilder::room(side_m, side_m, side_m);
    for (std::size_t i = 0; i < faces.size(); ++i) {
        scene.receiver(scene.object(wall_names[i], faces[i], paint));
    }
    scene.light("lamp", PointLight{Vec3::Constant(side_m / 2)}, flux_lm);
    const double illuminance = flux_lm / (6.0 * side_m * side_m * (1.0 - rho));
    std::vector<Check> checks;
    for (std::size_t i = 0; i < 6; i += 2) {
        checks.push_back({fmt::format("mean of {}", wall_names[i]), "illuminance", "lx",
                          illuminance, 0.0, scaled(sensor(2 * i), 1.0 / (side_m * side_m)), 0.01});
    }
    checks[0].sweep = {"after CIE 171, 5.8: closed cube", "reflectance", rho};
    return {
        fmt::format("cie171/5.8-{:g}", rho),
        fmt::format("after 5.8: source of 10000 lm in a cube of 4 m, reflectance {:g}", rho),
        "E = Phi/(A (1 - rho)), the balance of flux with the symmetry of the cube: exact, where "
        "the document's average formula needs care (Ashdown's errata)",
        scene.parts,
        effort(64, rays),
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

// 5.9 and 5.11 with skies that are not uniform, and a ground.
template <typename TruthSky>
Case general_sky(const std::string& id, const std::string& title, std::size_t wall,
                 const Hole& hole, const std::vector<WallPoint>& places,
                 const SkyPair<TruthSky>& skies) {
    constexpr double horizontal_lx = 10000.0, ground = 0.2;
    SceneBuilder scene;
    const Rectangle opening = room_with_hole(scene, wall, hole, false);
    const Vec3 normal = opening.edge_u.cross(opening.edge_v).normalized();
    const bool back = (Vec3(2.0, 2.0, 1.5) - opening.corner).dot(normal) < 0.0;
    const auto view =
        std::make_shared<const SkyView>(skies.engine, back ? Vec3(-normal) : normal, ground);
    scene.light(
        "sky",
        AreaLight{scene.object("opening", opening, pass_through), opening, false, back, view},
        horizontal_lx / skies.engine.horizontal_sr() * view->exitance_sr() * area_m2(opening));
    // The truth wants an upright edge second.
    const bool swapped = opening.edge_u.z() != 0.0;
    const Vec3 u = swapped ? opening.edge_v : opening.edge_u;
    const Vec3 v = swapped ? opening.edge_u : opening.edge_v;
    Points points{scene};
    for (const WallPoint& place : places) {
        points.add(place.name, place.position, place.normal,
                   truth::sky_illuminance(skies.truth, horizontal_lx, ground, opening.corner, u, v,
                                          place.position, place.normal));
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

}  // namespace

std::vector<Case> cie171_cases() {
    std::vector<Case> cases{
        point_source(3.0),
        point_source(1.5),
        area_source(1.0),
        area_source(2.0),
        flux_conservation(1.0),
        flux_conservation(3.0),
        diffuse_reflection(0.8),
        diffuse_reflection(0.3),
        obstruction(0.2),
        obstruction(0.4),
        internally_reflected(0.1, 10000),
        internally_reflected(0.5, 10000),
        internally_reflected(0.8, 10000),
        internally_reflected(0.95, 6000),
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
    return cases;
}

}  // namespace lucerna::validation
