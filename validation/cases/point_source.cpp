// Point sources: inverse square and cosine law, and a C-gamma table in rotated luminaires.
#include <fmt/format.h>

#include <algorithm>

#include "validation/cases.h"
#include "validation/scene_builder.h"
#include "validation/truth/luminaire.h"

namespace lucerna::validation {
namespace {

using namespace optics;

const std::vector<Vec3> floor_points{
    {0.0, 0.0, 0.0}, {1.0, 0.5, 0.0}, {-1.2, 0.3, 0.0}, {0.4, -1.5, 0.0}};
const Vec3 luminaire_position(0.1, 0.2, 2.0);

Case isotropic() {
    constexpr double intensity = 100.0, height_m = 2.0;  // cd
    constexpr double rho = 0.5;
    SceneBuilder scene;
    scene.light("lamp", PointLight{{0.0, 0.0, height_m}}, 4.0 * pi * intensity);
    scene.object("floor", Rectangle{{-5, -5, 0}, {10, 0, 0}, {0, 10, 0}}, scene.diffuse(rho));
    std::vector<Check> checks;
    const auto illuminance = [&](double x) {
        return intensity * height_m / std::pow(x * x + height_m * height_m, 1.5);
    };
    std::vector<Vec3> points;
    for (const double x : {0.0, 0.5, 1.0, 1.5, 2.0, 3.0, 4.0}) {
        checks.push_back({fmt::format("x = {:.1f} m", x), "illuminance", "lx", illuminance(x), 0.0,
                          sensor(checks.size()), 0.01, SweepPoint{"point source", "x [m]", x}});
        points.emplace_back(x, 0.0, 0.0);
    }
    scene.points(points, Vec3::UnitZ());
    scene.meter({1.0, 0.3, 1.0}, {1.0, 0.0, 0.0}, 0.005);
    const double value = rho / pi * illuminance(1.0);
    checks.push_back({"floor at x = 1.0 m", "luminance", "cd/m2", value, 1e-4 * value,
                      sensor(checks.size()), 0.01});
    return {"point_source/isotropic",
            "isotropic source 2 m over a floor",
            "E = I cos/d^2, L = rho E/pi",
            scene.parts,
            effort(64, 100),
            checks};
}

Case rotated(const std::string& id, double turn_deg, double lift_deg,
             const optics::Settings& settings = effort(64, 1000)) {
    constexpr double rho = 0.5;
    const Vec3& position = luminaire_position;
    const truth::Axes axes = truth::axes(turn_deg, lift_deg);
    Luminaire lamp;
    lamp.position = position;
    lamp.to_photometric.row(0) = axes.c0.transpose();
    lamp.to_photometric.row(1) = axes.c90.transpose();
    lamp.to_photometric.row(2) = axes.up.transpose();
    lamp.intensity = std::make_shared<const IntensityDistribution>(truth::c_deg, truth::gamma_deg,
                                                                   truth::table_cd);
    SceneBuilder scene;
    const double flux_lm = truth::total_flux_lm();
    const ObjectId shell = scene.object("shell", Sphere{position, 10.0}, scene.black());
    scene.receiver(shell);
    scene.object("paper", Disk{{1.0, 0.5, 0.0}, Vec3::UnitZ(), 0.1}, scene.diffuse(rho));
    scene.light("luminaire", lamp, flux_lm);
    scene.points(floor_points, Vec3::UnitZ());
    scene.meter({0.5, 0.5, 1.0}, {1.0, 0.5, 0.0}, 0.005);
    std::vector<Check> checks;
    for (std::size_t i = 0; i < floor_points.size(); ++i) {
        const Vec3 way = floor_points[i] - position;
        const Vec3 direction = way.normalized();
        const double value =
            truth::intensity_toward(axes, direction) * -direction.z() / way.squaredNorm();
        checks.push_back({fmt::format("floor point {}", i + 1), "illuminance", "lx", value, 0.0,
                          sensor(i), 0.01});
    }
    const double value = rho / pi * checks[1].truth;
    checks.push_back(
        {"paper at point 2", "luminance", "cd/m2", value, 2e-4 * value, sensor(4), 0.01});
    checks.push_back(
        {"shell around all", "luminous flux", "lm", flux_lm, 1e-9 * flux_lm, sensor(6), 0.01});
    return {
        id,
        fmt::format("C-gamma table, turned by {:g} deg and lifted by {:g} deg", turn_deg, lift_deg),
        "E = I(C, gamma) cos/d^2, I bilinear in the angles (IES LM-63 and EULUMDAT practice), "
        "C and gamma after CIE 121:1996",
        scene.parts,
        settings,
        checks};
}

}  // namespace

std::vector<Case> point_source_cases() {
    return {isotropic(), rotated("point_source/level", 0.0, 0.0),
            rotated("point_source/turned-25-lifted-15", 25.0, 15.0),
            rotated("point_source/turned-110-lifted-40", 110.0, 40.0)};
}

Case drawn_point_source(const std::string& id, Draw& draw) {
    struct Turn {
        double turn_deg, lift_deg;
    };
    const Turn drawn = first_that(
        [](const Turn& turn) {
            const truth::Axes axes = truth::axes(turn.turn_deg, turn.lift_deg);
            return std::ranges::all_of(floor_points, [&](const Vec3& point) {
                return truth::intensity_toward(axes, (point - luminaire_position).normalized()) >
                       1.0;
            });
        },
        [&] {
            return Turn{draw.between(0.0, 360.0), draw.between(-70.0, 70.0)};
        });
    return rotated(id, drawn.turn_deg, drawn.lift_deg, {});
}

}  // namespace lucerna::validation
