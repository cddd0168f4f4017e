// A dispersive prism at least deviation: two sheets meet where the middle of a beam must land, or a
// screen shows the spectrum.
#include <fmt/format.h>

#include "optics/geometry/mesh.h"
#include "spectral/photometry.h"
#include "validation/cases.h"
#include "validation/scene_builder.h"
#include "validation/truth/prism.h"
#include "validation/truth/root.h"
#include "validation/truth/spectral_mean.h"

namespace lucerna::validation {
namespace {

using namespace optics;

constexpr double apex_rad = pi / 3.0;
constexpr double height_m = 0.06;
const std::string prism_source =
    "n = sin((A + D) / 2) / sin(A / 2): Born and Wolf, 7th ed., 4.7.2; Fresnel with s and p apart";

// Cauchy's formula for a glass like a dense flint.
double index_at(double nm) {
    return 1.69 + 1.35e4 / (nm * nm);
}

// The apex edge is the y axis, the base below.
std::shared_ptr<const Mesh> prism_mesh() {
    const double half_base_m = height_m * std::tan(0.5 * apex_rad);
    constexpr double half_length_m = 0.05;
    std::vector<Vec3> vertices;
    for (const double y : {-half_length_m, half_length_m}) {
        vertices.emplace_back(0.0, y, 0.0);
        vertices.emplace_back(-half_base_m, y, -height_m);
        vertices.emplace_back(half_base_m, y, -height_m);
    }
    return prepare_mesh(
        std::move(vertices),
        {{0, 1, 2}, {3, 5, 4}, {0, 3, 4}, {0, 4, 1}, {1, 4, 5}, {1, 5, 2}, {2, 5, 3}, {2, 3, 0}});
}

// A beam of 20 mm across the principal section through the prism.
struct PrismScene {
    SceneBuilder builder;
    spectral::Spectrum index;
    truth::PrismScreen geometry;
    Vec3 middle;  // of the screen, where light of least deviation lands
    Vec3 out;     // where that light goes
    Vec3 beyond;  // in the plane of section, toward larger deviation
};
constexpr double beam_length_m = 0.02;

// @param light  relative spectral distribution.
PrismScene prism_scene(const spectral::Spectrum& light, double least_nm, double beam_width_m) {
    const double least_index = index_at(least_nm);
    const truth::PrismScreen geometry{
        apex_rad,    truth::least_deviation_incidence_rad(least_index, apex_rad),
        least_index, 0.035,
        1.0,         beam_width_m};

    SceneBuilder scene;
    const MediumId glass = scene.dispersive_medium(index_at);
    const spectral::Spectrum index = scene.parts.spectra[scene.parts.media[glass].index];
    scene.solid("prism", MeshInstance{prism_mesh(), Placement::Identity()}, glass);
    // Takes what the exit face reflects: after three reflections it would join the beam.
    scene.object("base", Rectangle{{-0.033, -0.049, -0.059}, {0.066, 0, 0}, {0, 0.098, 0}},
                 scene.black());

    const double half = 0.5 * apex_rad;
    const Vec3 entry_normal(-std::cos(half), 0.0, std::sin(half));
    const Vec3 exit_normal(std::cos(half), 0.0, std::sin(half));
    const Vec3 up_entry(std::sin(half), 0.0, std::cos(half));
    const Vec3 down_exit(std::sin(half), 0.0, -std::cos(half));
    const double incidence = geometry.incidence_rad;
    const Vec3 in = -std::cos(incidence) * entry_normal + std::sin(incidence) * up_entry;
    const Vec3 out = std::cos(incidence) * exit_normal + std::sin(incidence) * down_exit;
    const Vec3 across_in = Vec3::UnitY().cross(in);
    const Vec3 start = -geometry.entry_m * up_entry - 0.2 * in;
    scene.light("beam",
                BeamLight{Rectangle{start - 0.5 * beam_width_m * across_in -
                                        0.5 * beam_length_m * Vec3::UnitY(),
                                    beam_width_m * across_in, beam_length_m * Vec3::UnitY()},
                          in},
                lamp_flux_lm);
    scene.parts.lights.back().flux_w_per_nm =
        scene.parts.add(spectral::scaled_to_luminous(light, lamp_flux_lm));
    return {.builder = std::move(scene),
            .index = index,
            .geometry = geometry,
            .middle = geometry.entry_m * down_exit + geometry.screen_m * out,
            .out = out,
            .beyond = -std::sin(incidence) * exit_normal + std::cos(incidence) * down_exit};
}

// The flux that lands on each of two sheets, which meet in the middle.
Case at_least_deviation(const std::string& id, const std::string& title,
                        const spectral::Spectrum& light, double least_nm, double beam_width_m,
                        std::uint32_t phases) {
    PrismScene prism = prism_scene(light, least_nm, beam_width_m);
    SceneBuilder& scene = prism.builder;
    constexpr double sheet_m = 0.3;
    const Vec3 corner = prism.middle - 0.15 * Vec3::UnitY();
    for (const bool far : {true, false}) {
        const Vec3 along = sheet_m * prism.beyond;
        scene.receiver(
            scene.object(far ? "beyond" : "before",
                         Rectangle{far ? corner : Vec3(corner - along), along, 0.3 * Vec3::UnitY()},
                         scene.black()));
    }

    const auto light_at = [&](double nm) { return light.at(nm); };
    const auto landing = [&](double nm) {
        return truth::prism_landing(prism.geometry, prism.index.at(nm));
    };
    const double far = lamp_flux_lm * truth::luminous_mean(light_at, [&](double nm) {
                           return landing(nm).flux_beyond();
                       });
    const double all = lamp_flux_lm * truth::luminous_mean(light_at, [&](double nm) {
                           return landing(nm).transmittance;
                       });
    // The sheets' order of normals decides which side is the front; both sides are read.
    return {.id = id,
            .title = title,
            .source = prism_source,
            .scene = std::move(scene.parts),
            .settings = effort(phases, 8000),
            .checks = {
                {"beyond least deviation", "luminous flux", "lm", far, 1e-5 * all, sensor(1), 0.02},
                {"before it", "luminous flux", "lm", all - far, 1e-5 * all, sensor(3), 0.02}}};
}

// Illuminance and chromaticity where the middles of beams of some wavelengths land. Neighbouring
// wavelengths overlap there by the width of the beam.
Case spectrum_on_a_screen(double beam_width_m) {
    const auto light = [](double) { return 1.0; };
    PrismScene prism = prism_scene(1.0, 560.0, beam_width_m);
    SceneBuilder& scene = prism.builder;
    const Vec3 side = 0.15 * Vec3::UnitY();
    scene.object(
        "screen",
        Rectangle{prism.middle - 0.3 * prism.beyond - side, 0.6 * prism.beyond, 2.0 * side},
        scene.black());
    const auto landing = [&](double nm) {
        return truth::prism_landing(prism.geometry, prism.index.at(nm));
    };
    const double per_weight = lamp_flux_lm / truth::spectral_integral(spectral::v_lambda(), light,
                                                                      [](double) { return 1.0; });
    std::vector<Vec3> points;
    std::vector<Check> checks;
    for (const double nm : {450.0, 480.0, 510.0, 540.0, 570.0, 600.0, 640.0}) {
        const double at_m = landing(nm).middle_m;
        // Longer waves land before the point, and reach it with the rim of their beam that lies
        // beyond: `rim` is half a width with its sign.
        const auto of_rim = [&](double rim) {
            return truth::root(
                [&](double other_nm) {
                    const truth::PrismLanding there = landing(other_nm);
                    return there.middle_m + rim * there.width_m - at_m;
                },
                spectral::min_wavelength_nm, spectral::max_wavelength_nm);
        };
        const double shortest_nm = of_rim(-0.5);
        const double longest_nm = of_rim(0.5);
        const auto sum = [&](const spectral::Spectrum& weight) {
            return per_weight * truth::integral(
                                    [&](double other_nm) {
                                        const truth::PrismLanding there = landing(other_nm);
                                        return weight.at(other_nm) * there.transmittance /
                                               (there.width_m * beam_length_m);
                                    },
                                    shortest_nm, longest_nm, 400);
        };
        const double x = sum(spectral::x_bar());
        const double y = sum(spectral::v_lambda());
        const double z = sum(spectral::z_bar());
        const std::size_t i = points.size();
        const auto check = [&](const char* what, const char* quantity, const char* unit,
                               double truth, Read read, double detects) {
            checks.push_back({fmt::format("{} at {:g} nm", what, nm), quantity, unit, truth,
                              1e-5 * truth, std::move(read), detects});
        };
        check("illuminance", "illuminance", "lx", y, sensor(i), 0.12);
        constexpr double detects = 0.01;
        const double share_x = x / (x + y + z), share_y = y / (x + y + z);
        check("x", "chromaticity", "1", share_x, chromaticity_x(i), detects / share_x);
        check("y", "chromaticity", "1", share_y, chromaticity_y(i), detects / share_y);
        points.push_back(prism.middle + at_m * prism.beyond - lift_m * prism.out);
    }
    scene.points(std::move(points), -prism.out);
    return {fmt::format("prism/spectrum-{:g}-mm", 1e3 * beam_width_m),
            fmt::format("spectrum on a screen, of a white beam {:g} mm wide", 1e3 * beam_width_m),
            prism_source,
            std::move(scene.parts),
            effort(96, 20000),
            std::move(checks)};
}

// Light within a nanometre of one wavelength.
spectral::Spectrum line(double nm) {
    return {{nm - 1.0, nm, nm + 1.0}, {0.0, 1.0, 0.0}, spectral::Outside::zero};
}

}  // namespace

std::vector<Case> prism_cases() {
    std::vector<Case> cases;
    for (const double nm : {480.0, 546.0, 644.0}) {
        cases.push_back(at_least_deviation(
            fmt::format("prism/{:g}-nm", nm),
            fmt::format("beam of {:g} nm at least deviation, cut in two at its middle", nm),
            line(nm), nm, 0.004, 96));
    }
    cases.push_back(at_least_deviation("prism/white",
                                       "white beam spread by a prism, cut in two at 560 nm", 1.0,
                                       560.0, 0.002, 192));
    for (const double width_m : {0.002, 0.008}) cases.push_back(spectrum_on_a_screen(width_m));
    return cases;
}

}  // namespace lucerna::validation
