// Caustics of a ball and of a cylinder of glass in a parallel beam, on a screen behind.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "validation/cases.h"
#include "validation/scene_builder.h"
#include "validation/truth/chebyshev.h"
#include "validation/truth/round_lens.h"
#include "validation/truth/spectral_mean.h"

namespace lucerna::validation {
namespace {

using namespace optics;
using truth::RoundLens;

constexpr double radius_m = 0.03;
constexpr double beam_irradiance = 1000.0;  // lx
constexpr double beam_half_width_m = 1.5 * radius_m;
// Dark, so that light between screen and lens stays below 1e-5 of the caustic: 0.002 times the
// 4 % to 25 % of a half space that the lens takes, times the 8 % that it reflects.
constexpr double screen_reflectance = 0.002;

// Cauchy's formula: the index of the lens at 550 nm, and `b_nm2` of what falls with the wavelength.
struct Dispersion {
    double b_nm2 = 0.0;
    RoundLens at(RoundLens lens, double nm) const {
        lens.index += b_nm2 * (1.0 / (nm * nm) - 1.0 / (550.0 * 550.0));
        return lens;
    }
};

constexpr Dispersion crown{5e3};
// Where no wavelength has a fold of any order, with that dispersion at n = 1.5 and 4 radii.
const std::vector<double> smooth_heights{0.5, 0.7, 1.2};

// Lens at the origin, beam along z, of an equal-energy spectrum. Points lie half a millimetre
// before the screen.
// @param heights  from the axis, in radii of the lens; away from folds.
Case behind(const std::string& id, const RoundLens& lens, const std::vector<double>& heights,
            const optics::Settings& settings, const Dispersion& dispersion = {}) {
    SceneBuilder scene;
    const bool disperses = dispersion.b_nm2 > 0.0;
    const MediumId glass =
        disperses
            ? scene.dispersive_medium([&](double nm) { return dispersion.at(lens, nm).index; })
            : scene.medium(lens.index, lens.absorption_per_m);
    const Vec3 start(0.0, 0.0, -3.0 * radius_m);
    constexpr double beam_half_length_m = 0.05;
    if (lens.is_ball) {
        scene.solid("ball", Sphere{Vec3::Zero(), radius_m}, glass);
        const Disk section{start, Vec3::UnitZ(), beam_half_width_m};
        scene.light("beam", BeamLight{section, Vec3::UnitZ()}, beam_irradiance * area_m2(section));
    } else {
        scene.solid("cylinder", Cylinder{{0, -0.2, 0}, {0, 0.2, 0}, radius_m}, glass);
        const Rectangle section{start - Vec3(beam_half_width_m, beam_half_length_m, 0.0),
                                {2.0 * beam_half_width_m, 0, 0},
                                {0, 2.0 * beam_half_length_m, 0}};
        scene.light("beam", BeamLight{section, Vec3::UnitZ()}, beam_irradiance * area_m2(section));
    }
    const double screen_m = lens.screen_m + 0.0005;
    scene.object("screen", Rectangle{{-1, -1, screen_m}, {0, 2, 0}, {2, 0, 0}},
                 scene.diffuse(screen_reflectance));

    Case result{
        .id = id,
        .title = fmt::format("caustic of a {} of n = {:g}, absorption {:g} /m, at {:g} radii",
                             lens.is_ball ? "ball" : "cylinder", lens.index, lens.absorption_per_m,
                             lens.screen_m / radius_m) +
                 (disperses ? ", dispersive" : ""),
        .source = lens.is_ball ? "E = sum of E0 T(h) h |dh/dx| / x over branches, rays of Born and "
                                 "Wolf, 7th ed., 4.1 and 1.5.2; orders 0 to 12 of internal "
                                 "reflection, and reflection outside"
                               : "E = sum of E0 T(h) |dh/dx| over branches, rays of Born and Wolf, "
                                 "7th ed., 4.1 and 1.5.2; orders 0 to 12 of internal reflection, "
                                 "and reflection outside",
        .scene = {},
        .settings = settings,
        .checks = {}};
    const auto irradiance = [&](double at_m, double plane_m, int nodes) {
        RoundLens on_plane = lens;
        on_plane.screen_m = plane_m;
        const bool beside = at_m > radius_m && at_m < beam_half_width_m;
        const auto at = [&](double nm) {
            return beam_irradiance * (truth::lens_irradiance(dispersion.at(on_plane, nm), at_m) +
                                      (beside ? 1.0 : 0.0));
        };
        if (!disperses) return at(550.0);
        const truth::Chebyshev of_wavelength(at, spectral::min_wavelength_nm,
                                             spectral::max_wavelength_nm, nodes);
        return truth::luminous_mean([](double) { return 1.0; }, of_wavelength);
    };
    constexpr int enough_nodes = 6;  // within 1e-5 of 17 at smooth_heights
    // Relative, of the interpolation; 0 without dispersion.
    const auto spectral_error = [&](double at_m) {
        return std::abs(irradiance(at_m, lens.screen_m, 2 * enough_nodes) /
                            irradiance(at_m, lens.screen_m, enough_nodes) -
                        1.0);
    };
    const auto sweep = [&](const std::string& what, double height) {
        return SweepPoint{what, "distance from the axis [radii]", height};
    };
    std::vector<Vec3> points;
    for (const double height : heights) {
        const double at_m = height * radius_m;
        points.emplace_back(at_m, 0.0, lens.screen_m);
        const double truth = irradiance(at_m, lens.screen_m, enough_nodes);
        result.checks.push_back({.name = fmt::format("at {:g} radii", height),
                                 .quantity = "illuminance",
                                 .unit = "lx",
                                 .truth = truth,
                                 .truth_error = (2e-5 + spectral_error(at_m)) * truth,
                                 .read = sensor(result.checks.size()),
                                 .detects_relative = 0.06,
                                 .sweep = sweep("illuminance behind the lens", height)});
    }
    scene.points(points, -Vec3::UnitZ());
    for (const double height : heights) {
        const double at_m = height * radius_m;
        const Vec3 target(at_m, 0.0, screen_m);
        // From aside, so that the lens does not hide the screen; sees half a millimetre.
        scene.meter(target + Vec3(0.12, 0.0, -0.05), target, 0.001);
        const double truth = screen_reflectance / pi * irradiance(at_m, screen_m, enough_nodes);
        result.checks.push_back({.name = fmt::format("screen at {:g} radii", height),
                                 .quantity = "luminance",
                                 .unit = "cd/m2",
                                 .truth = truth,
                                 .truth_error = (5e-5 + spectral_error(at_m)) * truth,
                                 .read = sensor(result.checks.size()),
                                 .detects_relative = 0.15,
                                 .sweep = sweep("luminance of the screen", height)});
    }
    result.scene = std::move(scene.parts);
    return result;
}

// Three heights that light reaches and that are away from folds, rims and the shadow of the lens,
// where the truth varies too fast for what a meter sees of it.
Case drawn_lens(const std::string& id, Draw& draw, bool is_ball) {
    const double index = draw.between(1.25, 1.85);
    const Dispersion dispersion{draw.happens(0.3) ? draw.between(2e3, 8e3) : 0.0};
    const bool absorbs = dispersion.b_nm2 == 0.0 && draw.happens(0.7);
    const double absorption_per_m = absorbs ? draw.log_between(1.0, 20.0) : 0.0;
    const RoundLens lens{is_ball, radius_m, index, absorption_per_m,
                         draw.log_between(1.05, 6.0) * radius_m};
    constexpr double step = 0.02;  // radii
    const auto is_smooth = [&](double height, double nm) {
        const auto at = [&](double radii) {
            return truth::lens_irradiance(dispersion.at(lens, nm), radii * radius_m) +
                   (radii > 1.0 && radii < 1.5 ? 1.0 : 0.0);
        };
        const double here = at(height);
        return here > 0.05 &&
               std::abs(at(height - step) + at(height + step) - 2.0 * here) < 0.02 * here;
    };
    const auto fits = [&](double height) {
        if (std::abs(height - 1.0) < step || std::abs(height - 1.5) < step) return false;
        return std::ranges::all_of(
            std::array{400.0, 440.0, 480.0, 520.0, 560.0, 600.0, 640.0, 680.0},
            [&](double nm) { return is_smooth(height, nm); });
    };
    std::vector<double> heights;
    for (int i = 0; i < 3; ++i) {
        heights.push_back(first_that(fits, [&] { return draw.between(0.05, 1.8); }));
    }
    return behind(id, lens, heights, {}, dispersion);
}

}  // namespace

Case drawn_ball_lens(const std::string& id, Draw& draw) {
    return drawn_lens(id, draw, true);
}

Case drawn_cylinder_lens(const std::string& id, Draw& draw) {
    return drawn_lens(id, draw, false);
}

std::vector<Case> ball_lens_cases() {
    return {behind("ball_lens/beyond-focus", {true, radius_m, 1.5, 0.0, 4.0 * radius_m},
                   {0.2, 0.6, 1.2}, effort(640, 10000, 16)),
            behind("ball_lens/absorbing", {true, radius_m, 1.7, 10.0, 3.0 * radius_m},
                   {0.3, 0.7, 1.2}, effort(640, 10000, 16)),
            behind("ball_lens/before-focus", {true, radius_m, 1.3, 0.0, 1.1 * radius_m},
                   {0.08, 0.16}, effort(900, 10000, 16)),
            // All that the pilot finds is near the axis, a hundred times as bright as this.
            behind("ball_lens/faint-ring", {true, radius_m, 1.36, 0.0, 1.27 * radius_m},
                   {1.18, 1.35}, effort(64, 10000, 16)),
            behind("ball_lens/dispersive", {true, radius_m, 1.5, 0.0, 4.0 * radius_m},
                   smooth_heights, effort(160, 10000, 16), crown)};
}

std::vector<Case> cylinder_lens_cases() {
    return {behind("cylinder_lens/beyond-focus", {false, radius_m, 1.5, 0.0, 4.0 * radius_m},
                   {0.2, 0.6, 1.2}, effort(640, 10000, 16)),
            behind("cylinder_lens/absorbing", {false, radius_m, 1.7, 10.0, 3.0 * radius_m},
                   {0.3, 0.7, 1.2}, effort(640, 10000, 16)),
            behind("cylinder_lens/before-focus", {false, radius_m, 1.3, 0.0, 1.1 * radius_m},
                   {0.08, 0.16}, effort(640, 10000, 16)),
            behind("cylinder_lens/dispersive", {false, radius_m, 1.5, 0.0, 4.0 * radius_m},
                   smooth_heights, effort(160, 10000, 16), crown)};
}

}  // namespace lucerna::validation
