// The light of CIE illuminants has the published colour after its way through the engine.
#include <fmt/format.h>

#include "spectral/illuminants.h"
#include "spectral/photometry.h"
#include "validation/cases.h"
#include "validation/scene_builder.h"

namespace lucerna::validation {
namespace {

using namespace optics;

struct Published {
    const char* name;
    double x, y;
    double cct_k;           ///< 0: not printed
    double rounding;        ///< of x and y: half a unit of the last digit, and ...
    double sum_at_5_nm;     ///< ... what the CIE's sum at 5 nm differs from the integral by
    double cct_rounding_k;  ///< both, of the correlated colour temperature
};

// CIE 15:2018, chromaticities for the 2 deg observer and correlated colour temperatures:
// illuminants A, D and E, FL, HP, and LED; the same values as in CIE 15:2004, tables T.3, T.6 and
// T.7, but for LED.
constexpr std::array published{
    Published{"A", 0.44758, 0.40745, 2856.0, 5e-6, 3e-5, 2.0},
    Published{"D50", 0.34567, 0.35851, 5003.0, 5e-6, 3e-5, 3.0},
    Published{"D65", 0.31272, 0.32903, 6504.0, 5e-6, 3e-5, 3.0},
    Published{"E", 1.0 / 3.0, 1.0 / 3.0, 0.0, 0.0, 5e-5, 0.0},
    Published{"FL2", 0.3721, 0.3751, 4230.0, 5e-5, 3e-4, 8.0},
    Published{"FL11", 0.3805, 0.3769, 4000.0, 5e-5, 3e-4, 8.0},
    Published{"HP1", 0.5330, 0.4150, 1959.0, 5e-5, 3e-4, 6.0},
    Published{"LED-B3", 0.3756, 0.3723, 4103.0, 5e-5, 3e-4, 8.0},
    Published{"LED-RGB1", 0.4557, 0.4211, 2840.0, 5e-5, 3e-4, 4.0},
};

// Illuminance at 1 m from a point source: E = Phi / (4 pi d^2), in the light's own colour.
Case illuminant_case(const Published& of) {
    constexpr double flux_lm = 1000.0;
    SceneBuilder scene;
    scene.light("lamp", PointLight{{0.0, 0.0, 1.0}}, flux_lm);
    scene.parts.lights.back().flux_w_per_nm =
        scene.parts.add(spectral::scaled_to_luminous(*spectral::illuminant(of.name), flux_lm));
    scene.points({Vec3::Zero()}, Vec3::UnitZ());
    scene.object("floor", Rectangle{{-1, -1, -1}, {2, 0, 0}, {0, 2, 0}}, scene.black());
    const double error = of.rounding + of.sum_at_5_nm;
    Case result{
        .id = fmt::format("colour/{}", of.name),
        .title = fmt::format("illuminance by a point source of CIE illuminant {}", of.name),
        .source = "CIE 15:2018 (chromaticity and correlated colour temperature as printed)",
        .scene = std::move(scene.parts),
        .settings = effort(512, 16, 4),
        .checks = {{"illuminance", "illuminance", "lx", flux_lm / (4.0 * pi), 0.0, sensor(0)},
                   {"x", "chromaticity", "1", of.x, error, chromaticity_x(0)},
                   {"y", "chromaticity", "1", of.y, error, chromaticity_y(0)}}};
    if (of.cct_k > 0.0) {
        result.checks.push_back({"colour temperature", "correlated colour temperature", "K",
                                 of.cct_k, of.cct_rounding_k, colour_temperature_k(0), 0.04});
    }
    return result;
}

}  // namespace

std::vector<Case> colour_cases() {
    std::vector<Case> cases;
    for (const Published& of : published) cases.push_back(illuminant_case(of));
    return cases;
}

}  // namespace lucerna::validation
