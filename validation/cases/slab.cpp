// Slabs of glass: transmittance over the angle of incidence, and the shift of a beam.
#include <fmt/format.h>

#include "validation/cases.h"
#include "validation/scene_builder.h"
#include "validation/truth/tilted_slab.h"

namespace lucerna::validation {
namespace {

using namespace optics;

double radians(double degrees) {
    return degrees * pi / 180.0;
}

// Meters above a slab see an emitter of uniform luminance below it, each under its own angle.
Case over_emitter(const std::string& id, double index, double absorption_per_m, double thickness_m,
                  const std::vector<double>& angles_deg, const optics::Settings& settings) {
    constexpr double luminance = 1000.0;
    SceneBuilder scene;
    scene.area_light(
        scene.object("emitter", Rectangle{{-5, -5, 0}, {10, 0, 0}, {0, 10, 0}}, scene.black()),
        luminance);
    Placement place = Placement::Identity();
    place.translate(Vec3(-3.0, -3.0, 0.1));
    scene.solid("slab", Box{place, {6.0, 6.0, thickness_m}}, scene.medium(index, absorption_per_m));
    Case result{
        .id = id,
        .title = fmt::format("luminance through a slab of n = {:g}, absorption {:g} /m", index,
                             absorption_per_m),
        .source =
            "Fresnel with s and p apart, (1 - R)^2 a / (1 - R^2 a^2), a = exp(-alpha d / cos "
            "th'): Born and Wolf, 7th ed., 1.5.2, geometric series",
        .scene = {},
        .settings = settings,
        .checks = {}};
    for (const double degrees : angles_deg) {
        const double angle = radians(degrees);
        const Vec3 target(0.0, 0.0, 0.1 + thickness_m);
        scene.meter(target + Vec3(std::sin(angle), 0.0, std::cos(angle)), target, 0.001);
        const double truth =
            luminance * truth::slab_transmittance(index, angle, thickness_m, absorption_per_m);
        result.checks.push_back(
            {.name = fmt::format("{:g} deg", degrees),
             .quantity = "luminance",
             .unit = "cd/m2",
             .truth = truth,
             .truth_error = 1e-5 * truth,  // the meter's cone of 1 mrad
             .read = sensor(result.checks.size()),
             .detects_relative = 0.01,
             .sweep = SweepPoint{"transmittance of a slab", "angle of incidence [deg]", degrees}});
    }
    result.scene = std::move(scene.parts);
    return result;
}

// A beam along -z through a tilted slab; two sheets meet below where the middle of the light that
// is reflected never must land.
Case beam(const std::string& id, double degrees, double index, double absorption_per_m,
          double thickness_m, const optics::Settings& settings) {
    constexpr double flux_lm = 1000.0;
    constexpr double width_m = 0.01;
    const double angle = radians(degrees);
    SceneBuilder scene;
    // The normal of the cross section is edge_u x edge_v = -z.
    scene.light("beam",
                BeamLight{Rectangle{{-0.5 * width_m, -0.01, 1.0}, {0, 0.02, 0}, {width_m, 0, 0}},
                          -Vec3::UnitZ()},
                flux_lm);
    Placement place = Placement::Identity();
    place.translate(Vec3(0.0, 0.0, 0.5));
    place.rotate(Eigen::AngleAxisd(angle, Vec3::UnitY()));
    place.translate(Vec3(-0.5, -0.5, -0.5 * thickness_m));
    scene.solid("slab", Box{place, {1.0, 1.0, thickness_m}}, scene.medium(index, absorption_per_m));
    // The normal of the slab, taken with the beam, is (-sin, 0, -cos): light is shifted toward -x.
    const double edge_m =
        truth::slab_beam(index, angle, thickness_m, absorption_per_m, 0).displacement_m;
    for (const double side : {-1.0, 1.0}) {
        // Narrow enough to miss the beam that the slab reflects.
        const Vec3 u(0.2, 0.0, 0.0);
        const Vec3 corner(side < 0.0 ? -edge_m - u.x() : -edge_m, -0.5, 0.0);
        scene.receiver(scene.object(side < 0.0 ? "beyond" : "before",
                                    Rectangle{corner, u, Vec3::UnitY()}, scene.black()));
    }
    const double all =
        flux_lm * truth::slab_transmittance(index, angle, thickness_m, absorption_per_m);
    const double beyond = flux_lm * truth::slab_flux_beyond(index, angle, thickness_m,
                                                            absorption_per_m, width_m, edge_m);
    return {.id = id,
            .title = fmt::format("beam of 10 mm shifted by {:.3f} mm in a slab of n = {:g} at {:g} "
                                 "deg, cut in two at its middle",
                                 1e3 * edge_m, index, degrees),
            .source =
                "shift d sin th (1 - cos th / (n cos th')): Hecht, Optics, 5th ed., problem "
                "4.38; internal reflections follow at 2 d tan th' cos th",
            .scene = std::move(scene.parts),
            .settings = settings,
            .checks = {
                {"beyond the edge", "luminous flux", "lm", beyond, 1e-9 * all, sensor(0)},
                {"before the edge", "luminous flux", "lm", all - beyond, 1e-9 * all, sensor(2)}}};
}

}  // namespace

std::vector<Case> slab_cases() {
    const std::vector<double> angles_deg{0.0, 30.0, 45.0, 60.0, 75.0};
    return {over_emitter("slab/clear", 1.5, 0.0, 0.1, angles_deg, effort(64, 100, 25)),
            over_emitter("slab/absorbing", 1.6, 4.0, 0.1, angles_deg, effort(64, 100, 25)),
            beam("slab/shift-30-deg", 30.0, 1.5, 0.0, 0.025, effort(96, 8000)),
            beam("slab/shift-60-deg", 60.0, 1.6, 5.0, 0.025, effort(96, 8000))};
}

Case drawn_slab(const std::string& id, Draw& draw) {
    const double index = draw.between(1.2, 2.2);
    const double absorption_per_m = draw.happens(0.5) ? draw.log_between(0.1, 30.0) : 0.0;
    if (draw.happens(0.5)) {
        return beam(id, draw.between(10.0, 70.0), index, absorption_per_m, draw.between(0.01, 0.04),
                    {});
    }
    std::vector<double> angles_deg;
    for (int i = 0; i < 5; ++i) angles_deg.push_back(draw.between(16.0 * i, 16.0 * i + 14.0));
    return over_emitter(id, index, absorption_per_m, draw.between(0.01, 0.2), angles_deg, {});
}

}  // namespace lucerna::validation
