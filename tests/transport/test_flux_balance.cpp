// Light that is emitted is absorbed, received, escaped, trapped or lost by a named cause.
#include <catch2/catch.hpp>

#include "optics/transport/simulate.h"
#include "tests/support/check_mean.h"
#include "tests/support/cornell_scenes.h"

using namespace lucerna;
using namespace lucerna::optics;

namespace {

Result run(const SceneParts& parts, std::uint32_t phases, std::uint32_t rays) {
    Settings settings;
    settings.seed = 3;
    settings.max_phases = phases;
    settings.forward_rays = rays;
    return simulate(parts, settings);
}

}  // namespace

TEST_CASE("The flux balance closes", "[unit]") {
    const Result result = run(test::cornell_caustic(16).parts, 4, 5000);
    const FluxBalance& flux = result.flux_balance_lm;
    // Sums of 2e4 rays of about ten float roundings of 6e-8 each; they do not add up in one sense.
    CHECK(std::abs(flux.closure()) < 1e-6 * flux.emitted);
    CHECK(flux.inconsistent_medium == 0.0);
    CHECK(flux.numerical == 0.0);
    CHECK(flux.trapped == 0.0);
}

TEST_CASE("Each of several lights brings its own flux", "[analytic]") {
    // Beams onto plates of their own.
    validation::SceneBuilder scene;
    const std::vector<double> fluxes_lm{200.0, 300.0, 500.0};
    for (std::size_t i = 0; i < fluxes_lm.size(); ++i) {
        const Vec3 place(static_cast<double>(i), 0.0, 0.0);
        const Vec3 down = -Vec3::UnitZ();
        scene.light("beam", BeamLight{Disk{place + Vec3::UnitZ(), down, 0.1}, down}, fluxes_lm[i]);
        scene.receiver(scene.object("plate", Disk{place, Vec3::UnitZ(), 0.2}, scene.black()));
    }
    const Result result = run(scene.parts, 40, 60000);
    CHECK_THAT(result.flux_balance_lm.emitted, Catch::Matchers::WithinRel(1000.0, 5e-3));
    for (std::size_t i = 0; i < fluxes_lm.size(); ++i) {
        const Estimate& received = result.quantities[2 * i].estimate;
        test::check_mean(received.mean(), received.standard_error(), fluxes_lm[i], {0.02});
        CHECK_FALSE(test::agrees(received.mean(), received.standard_error(), 1000.0 / 3.0));
    }
}

TEST_CASE("A long rod loses nothing that is not accounted for", "[analytic]") {
    // A collimated beam enters the end face of a rod of 1 m length and 0.1 mm radius and runs at
    // the internal angle b, sin b = sin a / n: a meridional ray is reflected tan(b) / 0.2 mm = 2377
    // times, a skew ray more often. The rod is lossless and both ends reflect R, so the far end
    // passes (1 - R)^2 (1 + R^2 + R^4 + ...) = (1 - R) / (1 + R).
    const double n = 1.5;
    const double a = 0.7;
    const double b = std::asin(std::sin(a) / n);
    validation::SceneBuilder scene;
    scene.solid("rod", Cylinder{{0, 0, 0}, {0, 0, 1.0}, 0.0001}, scene.medium(n));
    const Vec3 direction = Vec3(std::sin(a), 0.0, std::cos(a));
    scene.light("beam", BeamLight{Disk{-0.001 * direction, direction, 0.00004}, direction}, 100.0);
    const ObjectId far_end =
        scene.object("far end", Disk{{0, 0, 1.001}, Vec3::UnitZ(), 1.0}, scene.black());
    scene.receiver(far_end);
    const Result result = run(scene.parts, 40, 200);
    const FluxBalance& flux = result.flux_balance_lm;
    CHECK(std::abs(flux.closure()) < 1e-6 * flux.emitted);
    CHECK(flux.inconsistent_medium == 0.0);
    CHECK(flux.trapped == 0.0);
    // Roulette ends half of the lossless paths at each power of two from 1024 on.
    CHECK(result.rays.forward_segments > 40u * 200u * 1000u);

    // Fresnel's equations by the angles, unpolarised.
    const double s_wave = std::sin(a - b) / std::sin(a + b);
    const double p_wave = std::tan(a - b) / std::tan(a + b);
    const double reflectance = (s_wave * s_wave + p_wave * p_wave) / 2.0;
    const double passed_lm = 100.0 * (1.0 - reflectance) / (1.0 + reflectance);
    const Estimate& back = result.quantities.at(1).estimate;  // the side toward the rod
    INFO("far end " << back.mean() << " +/- " << back.standard_error() << " lm, truth "
                    << passed_lm);
    CHECK(test::agrees(back.mean(), back.standard_error(), passed_lm));
    CHECK(back.standard_error() < 0.03 * passed_lm);
    CHECK_FALSE(test::agrees(back.mean(), back.standard_error(), 0.75 * passed_lm));
}

TEST_CASE("A lossless rod holds part of an isotropic emitter for ever", "[analytic]") {
    // On the axis only meridional rays: those between the critical angle of the side, theta > 90
    // deg - critical, and of the end, theta > critical, are held: cos theta in (cos(90 - c), cos
    // c), on both halves of the sphere. n = 1.49: c = 42.16 deg, cos c - sin c = 0.0701.
    validation::SceneBuilder scene;
    const double n = 1.49;
    scene.solid("rod", Cylinder{{0, 0, 0}, {0, 0, 0.2}, 0.005}, scene.medium(n));
    scene.light("point", PointLight{{0, 0, 0.1}}, 100.0);
    const ObjectId shell = scene.object("shell", Sphere{{0, 0, 0.1}, 1.0}, scene.black());
    scene.receiver(shell);
    const Result result = run(scene.parts, 4, 2000);
    const FluxBalance& flux = result.flux_balance_lm;
    const double critical = std::asin(1.0 / n);
    const double held = std::abs(std::cos(critical) - std::sin(critical));
    // Binomial over 8000 rays, each of which may stand for up to 2^6 rays by roulette.
    const double weight = 64.0;
    const double error = std::sqrt(held * weight / 8000.0);
    INFO("held " << flux.trapped / flux.emitted << " expected " << held);
    CHECK(std::abs(flux.trapped / flux.emitted - held) < test::level_1e6 * error);
    CHECK(flux.trapped > 0.0);
    CHECK(std::abs(flux.closure()) < 1e-6 * flux.emitted);
}
