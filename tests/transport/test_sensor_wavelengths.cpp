// Sensors that read light behind dispersive glass: it has all wavelengths in each phase, though a
// phase has few in common.
#include <set>

#include "optics/transport/phase_trace.h"
#include "tests/support/truth_checks.h"
#include "validation/truth/chebyshev.h"
#include "validation/truth/round_lens.h"
#include "validation/truth/spectral_mean.h"

using namespace lucerna;
using namespace lucerna::optics;
using test::SceneBuilder;

namespace {

/// A ball of crown glass in a beam of equal energy, with a point close before a screen.
struct BallBeforeScreen {
    static constexpr double radius_m = 0.03, irradiance_lx = 1000.0, height_m = 0.7 * radius_m;
    static constexpr truth::RoundLens ball{true, radius_m, 1.5, 0.0, 4.0 * radius_m};

    static double index_at(double nm) { return 1.5 + 5e3 * (1.0 / (nm * nm) - 1.0 / 3.025e5); }

    /// @param screen_reflectance  0: black, so that nothing in the scene scatters.
    static SceneBuilder scene(double screen_reflectance, const Disk& section) {
        SceneBuilder builder;
        builder.solid("ball", Sphere{Vec3::Zero(), radius_m}, builder.dispersive_medium(index_at));
        builder.light("beam", BeamLight{section, Vec3::UnitZ()}, irradiance_lx * area_m2(section));
        builder.object(
            "screen", Rectangle{{-1, -1, ball.screen_m + 1e-6}, {0, 2, 0}, {2, 0, 0}},
            screen_reflectance > 0.0 ? builder.diffuse(screen_reflectance) : builder.black());
        builder.points({{height_m, 0, ball.screen_m}}, -Vec3::UnitZ());
        return builder;
    }
};

}  // namespace

TEST_CASE("Photons before a screen have the flux of those on it, and many more wavelengths",
          "[statistical]") {
    const SceneBuilder scene =
        BallBeforeScreen::scene(0.5, {{0.01, 0, -0.09}, Vec3::UnitZ(), 0.002});
    const Stage stage(scene.parts);
    const SensorPlanes planes(stage.parts(), stage.caster(), 1.0);
    const Readings readings(scene.parts, Settings{});
    const TraceContext context{stage, planes, readings, Scheduler::ordered, 1};
    constexpr std::uint32_t rays = 1024;
    // Luminous flux, and Z, of which the wavelengths of a phase bring very unequal parts.
    std::array<Estimate, 2> before, on;
    std::set<long> colours;
    for (std::uint32_t number = 0; number < 400; ++number) {
        const Phase phase(stage, 1, number);
        ForwardTally unused(stage.parts());
        Lanes before_lm = Lanes::Zero(), on_lm = Lanes::Zero();
        for (const Photon& photon :
             trace_photons(phase, context, Emission(phase, RandomPurpose::caustic),
                           Reach::first_scattering, mask(History::caustic), rays, unused)) {
            if (photon.point.object != no_object) {
                on_lm += phase.tristimulus(photon.flux);
                continue;
            }
            before_lm += photon.flux;
            const double share = static_cast<double>(photon.flux[0] / photon.flux.sum());
            if (number == 0) colours.insert(std::lround(1e5 * share));
        }
        for (const int part : {0, 1}) {
            before[part].add(static_cast<double>(before_lm[1 + part]) / rays, 0.0);
            on[part].add(static_cast<double>(on_lm[1 + part]) / rays, 0.0);
        }
    }
    for (const int part : {0, 1}) {
        CAPTURE(before[part].standard_error(), on[part].standard_error());
        test::check_mean(before[part].mean(),
                         std::hypot(before[part].standard_error(), on[part].standard_error()),
                         on[part].mean(), {part == 0 ? 0.02 : 0.3});
    }
    CHECK(colours.size() > 10 * spectral::lane_count);
    CHECK(before[1].standard_error() < 0.3 * on[1].standard_error());
}

TEST_CASE("The colour of light behind dispersive glass is known as well as its photons allow",
          "[analytic]") {
    SceneBuilder scene = BallBeforeScreen::scene(
        0.0, {{0, 0, -0.09}, Vec3::UnitZ(), 1.5 * BallBeforeScreen::radius_m});
    const Result result = test::run(scene, Method::combined, {32, 10000});
    const truth::Chebyshev irradiance(
        [](double nm) {
            truth::RoundLens ball = BallBeforeScreen::ball;
            ball.index = BallBeforeScreen::index_at(nm);
            return truth::lens_irradiance(ball, BallBeforeScreen::height_m);
        },
        spectral::min_wavelength_nm, spectral::max_wavelength_nm, 9);
    const auto light = [](double) { return 1.0; };
    const auto sum = [&](const spectral::Spectrum& weight) {
        return truth::spectral_integral(weight, light, irradiance);
    };
    const double x = sum(spectral::x_bar()), y = sum(spectral::v_lambda()),
                 z = sum(spectral::z_bar());
    const Quantity& point = result.quantities[0];
    const auto check = [](const Uncertain& value, double truth) {
        CAPTURE(value.value, value.standard_error, truth);
        test::check_mean(value.value, value.standard_error, truth, {0.1});
        CHECK(value.standard_error < 0.012 * truth);
    };
    check(point.colour->x, x / (x + y + z));
    check(point.colour->y, y / (x + y + z));
    const double white_y = truth::spectral_integral(spectral::v_lambda(), light, light);
    check(point.result(), BallBeforeScreen::irradiance_lx * y / white_y);
}
