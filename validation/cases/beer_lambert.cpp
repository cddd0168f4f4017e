// Absorption without reflection: a medium of n = 1 that absorbs.
#include <fmt/format.h>

#include "validation/cases.h"
#include "validation/scene_builder.h"
#include "validation/truth/spectral_mean.h"

namespace lucerna::validation {
namespace {

using namespace optics;

constexpr double thickness_m = 0.2;
constexpr double luminance = 1000.0;

// A plate over an emitter, seen by meters under two angles; beside it, a beam through the same
// medium.
Case plate(const std::string& id, const std::string& title, const spectral::Spectrum& absorption) {
    SceneBuilder scene;
    const MediumId medium = scene.medium(1.0, absorption.max());
    scene.parts.spectra[scene.parts.media[medium].absorption_per_m] = absorption;
    scene.area_light(
        scene.object("emitter", Rectangle{{-5, -5, 0}, {10, 0, 0}, {0, 10, 0}}, scene.black()),
        luminance);
    Placement place = Placement::Identity();
    place.translate(Vec3(-3.0, -3.0, 0.1));
    scene.solid("plate", Box{place, {6.0, 6.0, thickness_m}}, medium);

    const auto mean = [&](const spectral::Spectrum& weight, double path_m) {
        return truth::spectral_integral(
                   weight, [](double) { return 1.0; },
                   [&](double nm) { return std::exp(-absorption.at(nm) * path_m); }) /
               truth::spectral_integral(
                   weight, [](double) { return 1.0; }, [](double) { return 1.0; });
    };
    Case result{.id = id,
                .title = title,
                .source =
                    "exp(-alpha d / cos th) at each wavelength (Bouguer, Lambert and Beer), "
                    "integral over CIE 1931 functions (ISO/CIE 11664-1)",
                .scene = {},
                .settings = effort(256, 1000, 16),
                .checks = {}};
    const std::vector<double> angles_deg{0.0, 60.0};
    for (std::size_t i = 0; i < angles_deg.size(); ++i) {
        const double angle = angles_deg[i] * pi / 180.0;
        const Vec3 target(0.0, 0.0, 0.1 + thickness_m);
        scene.meter(target + Vec3(std::sin(angle), 0.0, std::cos(angle)), target, 0.001);
        const double path_m = thickness_m / std::cos(angle);
        // X, Y and Z of the light are alike: equal energy.
        const double x = mean(spectral::x_bar(), path_m);
        const double y = mean(spectral::v_lambda(), path_m);
        const double z = mean(spectral::z_bar(), path_m);
        const std::string at = fmt::format("{:g} deg", angles_deg[i]);
        const double small = 1e-5;  // the meter's cone, tables at 1 nm
        result.checks.push_back(
            {at, "luminance", "cd/m2", luminance * y, small * luminance * y, sensor(i)});
        if (absorption.is_constant()) continue;
        result.checks.push_back(
            {at + ", x", "chromaticity", "1", x / (x + y + z), small, chromaticity_x(i), 0.02});
        result.checks.push_back(
            {at + ", y", "chromaticity", "1", y / (x + y + z), small, chromaticity_y(i), 0.02});
    }
    result.scene = std::move(scene.parts);
    return result;
}

Case beam(const std::string& id, const std::string& title, const spectral::Spectrum& absorption) {
    SceneBuilder scene;
    const MediumId medium = scene.medium(1.0, absorption.max());
    scene.parts.spectra[scene.parts.media[medium].absorption_per_m] = absorption;
    Placement place = Placement::Identity();
    place.translate(Vec3(-0.5, -0.5, 0.1));
    scene.solid("plate", Box{place, {1.0, 1.0, thickness_m}}, medium);
    // Askew: 40 deg to the normal of the plate.
    const Vec3 direction(std::sin(0.7), 0.0, -std::cos(0.7));
    scene.light("beam",
                BeamLight{Disk{-0.5 * direction + Vec3(0, 0, 0.2), direction, 0.01}, direction},
                lamp_flux_lm);
    scene.receiver(
        scene.object("sheet", Rectangle{{-2, -2, 0}, {4, 0, 0}, {0, 4, 0}}, scene.black()));
    const double path_m = thickness_m / std::cos(0.7);
    const double truth =
        lamp_flux_lm *
        truth::luminous_mean([](double) { return 1.0; },
                             [&](double nm) { return std::exp(-absorption.at(nm) * path_m); });
    return {.id = id,
            .title = title,
            .source = "exp(-alpha d / cos th) at each wavelength (Bouguer, Lambert and Beer)",
            .scene = std::move(scene.parts),
            .settings = effort(256, 1000),
            .checks = {{"passed", "luminous flux", "lm", truth, 1e-5 * truth, sensor(0)}}};
}

// Absorbs blue eight times as much as red.
spectral::Spectrum amber() {
    return {{360.0, 830.0}, {16.0, 2.0}, spectral::Outside::hold};
}

}  // namespace

std::vector<Case> beer_lambert_cases() {
    return {plate("beer_lambert/grey-plate", "emitter seen through a grey medium", 3.0),
            plate("beer_lambert/amber-plate", "emitter and its colour through an amber medium",
                  amber()),
            beam("beer_lambert/grey-beam", "beam through a grey medium", 5.0),
            beam("beer_lambert/amber-beam", "beam through an amber medium", amber())};
}

}  // namespace lucerna::validation
