// After test cases of CIE 171:2006 that have an analytic truth: lamps and reflection. Geometry and
// numbers are our own, stated in each case: the tables of the document are not used, because some
// are known to be wrong (I. Ashdown, errata at lightinganalysts.com/cie-1712006-errata: Table 19 of
// 5.7, 5.8, 5.11). All truths are derived here from form factors and balances of flux.
#include "validation/cases/cie171.h"

#include "validation/cases.h"

namespace lucerna::validation {
namespace {

using namespace optics;

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
    const std::array<std::string, 6> face_names{"wall -x", "wall +x", "wall -y",
                                                "wall +y", "floor",   "ceiling"};
    for (std::size_t i = 0; i < faces.size(); ++i) {
        scene.receiver(scene.object(face_names[i], faces[i], paint));
    }
    scene.light("lamp", PointLight{Vec3::Constant(side_m / 2)}, flux_lm);
    const double illuminance = flux_lm / (6.0 * side_m * side_m * (1.0 - rho));
    std::vector<Check> checks;
    for (std::size_t i = 0; i < 6; i += 2) {
        checks.push_back({fmt::format("mean of {}", face_names[i]), "illuminance", "lx",
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

}  // namespace

std::vector<Case> cie171_cases() {
    std::vector<Case> cases{
        point_source(3.0),
        point_source(1.5),
        area_source(1.0),
        area_source(2.0),
        diffuse_reflection(0.8),
        diffuse_reflection(0.3),
        obstruction(0.2),
        obstruction(0.4),
        internally_reflected(0.1, 10000),
        internally_reflected(0.5, 10000),
        internally_reflected(0.8, 10000),
        internally_reflected(0.95, 6000),
    };
    for (Case& each : cie171_daylight_cases()) cases.push_back(std::move(each));
    return cases;
}

}  // namespace lucerna::validation
