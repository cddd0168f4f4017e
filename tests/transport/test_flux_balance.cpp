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

TEST_CASE("A long rod loses nothing that is not accounted for", "[analytic]") {
    // A collimated beam enters the end face of a rod of 1 m length and 1 mm radius under 40 deg and
    // is totally reflected on its way, over 1000 times for a skew ray; lossless, so what is not
    // reflected at the two end faces leaves at the far end.
    test::SceneBuilder scene;
    scene.solid("rod", Cylinder{{0, 0, 0}, {0, 0, 1.0}, 0.0005}, scene.medium(1.5));
    const Vec3 direction = Vec3(std::sin(0.7), 0.0, std::cos(0.7));
    scene.light("beam", BeamLight{Disk{-0.001 * direction, direction, 0.0002}, direction}, 100.0);
    const ObjectId far_end =
        scene.object("far end", Disk{{0, 0, 1.001}, Vec3::UnitZ(), 1.0}, scene.black());
    scene.receiver(far_end);
    const Result result = run(scene.parts, 8, 2000);
    const FluxBalance& flux = result.flux_balance_lm;
    CHECK(std::abs(flux.closure()) < 1e-6 * flux.emitted);
    CHECK(flux.inconsistent_medium == 0.0);
    CHECK(flux.trapped == 0.0);
    CHECK(result.rays.forward_segments > 8u * 2000u * 100u);
}

TEST_CASE("A lossless rod holds part of an isotropic emitter for ever", "[analytic]") {
    // On the axis only meridional rays: those between the critical angle of the side, theta > 90
    // deg - critical, and of the end, theta > critical, are held: cos theta in (cos(90 - c), cos
    // c), on both halves of the sphere. n = 1.49: c = 42.16 deg, cos c - sin c = 0.0701.
    test::SceneBuilder scene;
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
