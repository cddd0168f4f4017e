// Skies and what an opening shows of them, against closed forms.
#include "light_checks.h"
#include "optics/light/light.h"

using namespace lucerna;
using namespace lucerna::optics;
using namespace lucerna::test;
using Catch::Matchers::WithinRel;

namespace {

const Vec3 up = Vec3::UnitZ();
const Vec3 sun = Vec3(1.0, 0.0, 1.0).normalized();

/// A square of 1 m2 in the wall x = 0; light comes in along +x.
AreaLight window(const Sky& sky, double ground) {
    const Rectangle opening{Vec3::Zero(), Vec3::UnitY(), Vec3::UnitZ()};
    return {3, opening, false, false, std::make_shared<const SkyView>(sky, Vec3::UnitX(), ground)};
}

}  // namespace

TEST_CASE("The sky gives an open plane what its integral says", "[light][analytic]") {
    // Type 5 is uniform: E = pi L.
    CHECK_THAT(Sky::general(5, up, up).horizontal_sr(), WithinRel(pi, 1e-5));
    // 2 pi times the integral of (1 + 2 s) / 3 * s from 0 to 1.
    CHECK_THAT(Sky::overcast(up).horizontal_sr(), WithinRel(2.0 * pi * 7.0 / 18.0, 1e-12));
    // Type 1, by Simpson's rule over s = sin(elevation).
    const auto weighted = [](double s) {
        return s == 0.0 ? 0.0 : (1.0 + 4.0 * std::exp(-0.7 / s)) / (1.0 + 4.0 * std::exp(-0.7)) * s;
    };
    double sum = 0.0;
    constexpr int steps = 2000;
    for (int i = 0; i < steps; i += 2) {
        sum += weighted(i / double{steps}) + 4.0 * weighted((i + 1) / double{steps}) +
               weighted((i + 2) / double{steps});
    }
    const double truth = 2.0 * pi * sum / (3.0 * steps);
    CHECK_THAT(Sky::general(1, up, up).horizontal_sr(), WithinRel(truth, 1e-5));
    // The overcast sky of ISO 15469 comes close to the older formula, and no closer.
    CHECK_THAT(truth, WithinRel(Sky::overcast(up).horizontal_sr(), 0.02));
    CHECK_THAT(truth, !WithinRel(Sky::overcast(up).horizontal_sr(), 1e-4));
}

TEST_CASE("Skies are stated over their zenith and brightest around the sun", "[light]") {
    for (int type = 1; type <= 15; ++type) {
        INFO("type " << type);
        const Sky sky = Sky::general(type, up, sun);
        CHECK_THAT(sky.relative_luminance(up), WithinRel(1.0, 1e-12));
        const Vec3 opposite(-sun.x(), 0.0, sun.z());
        if (Sky::depends_on_sun(type)) {
            CHECK(sky.relative_luminance(sun) > 1.2 * sky.relative_luminance(opposite));
        } else {
            CHECK_THAT(sky.relative_luminance(sun),
                       WithinRel(sky.relative_luminance(opposite), 1e-12));
        }
    }
    CHECK_THROWS_AS(Sky::general(0, up, sun), std::invalid_argument);
    CHECK_THROWS_AS(Sky::general(16, up, sun), std::invalid_argument);
    // Clear sky, type 12, with the sun in the zenith: f(chi) phi(Z) / (f(0) phi(0)) at Z = 60 deg,
    // by hand.
    const double gradation = (1.0 - std::exp(-0.64)) / (1.0 - std::exp(-0.32));
    const double rest = std::exp(-1.5 * pi);
    const double indicatrix =
        (1.0 + 10.0 * (std::exp(-pi) - rest) + 0.45 / 4.0) / (1.0 + 10.0 * (1.0 - rest) + 0.45);
    CHECK_THAT(Sky::general(12, up, up).relative_luminance({std::sqrt(0.75), 0.0, 0.5}),
               WithinRel(gradation * indicatrix, 1e-12));
}

TEST_CASE("An opening emits what it shows of sky and ground", "[light][analytic]") {
    // A uniform sky over a ground that reflects all of it is the same everywhere.
    const AreaLight even = window(Sky::general(5, up, up), 1.0);
    CHECK_THAT(even.sky->exitance_sr(), WithinRel(pi, 1e-5));
    // Overcast sky and black ground: E of a vertical plane is Lz / 3 (pi / 2 + 4 / 3), from the
    // integral of (1 + 2 sin e) cos^2 e de over 0 to pi/2 times 2 for the azimuths.
    const AreaLight overcast = window(Sky::overcast(up), 0.0);
    CHECK_THAT(overcast.sky->exitance_sr(), WithinRel((pi / 2.0 + 4.0 / 3.0) / 3.0, 1e-5));

    const LightSource source = window(Sky::general(12, up, sun), 0.3);
    const auto& view = *std::get<AreaLight>(source).sky;
    constexpr std::uint32_t rays = 200000;
    const Mean weights =
        mean_of(rays, [&](const auto& u) { return emit(source, u[0], u[1], u[2], u[3]).weight; });
    check_mean(weights.value, weights.standard_error, 1.0, {0.02});
    // Light from the ground goes up: its share of the flux is rho E / pi * pi / 2 over the
    // exitance.
    const double share =
        0.3 * Sky::general(12, up, sun).horizontal_sr() / pi * (pi / 2.0) / view.exitance_sr();
    const Mean rising = mean_of(rays, [&](const auto& u) {
        const EmittedRay ray = emit(source, u[0], u[1], u[2], u[3]);
        return ray.ray.direction.z() > 0.0 ? ray.weight : 0.0;
    });
    check_mean(rising.value, rising.standard_error, share, {0.05});
    CHECK_FALSE(agrees(rising.value, rising.standard_error, 1.0 - share));  // twin: upside down
    // What is seen of it: L / Phi = relative luminance / (exitance * area), on one side.
    SurfacePoint at{{0, 0.5, 0.5}, Vec3::UnitX(), 3, 0, 0};
    const Vec3 leaving = Vec3(1.0, 0.0, -1.0).normalized();
    CHECK_THAT(radiance_factor(source, at, leaving),
               WithinRel(view.relative_luminance(-leaving) / view.exitance_sr(), 1e-12));
    CHECK(radiance_factor(source, at, -leaving) == 0.0);
    const auto lit = illuminate(source, {1.0, 0.5, 0.5}, 0.5, 0.5);
    REQUIRE(lit);
    CHECK_THAT(lit->factor * lit->pdf_solid_angle,
               WithinRel(radiance_factor(source, at, -lit->direction), 1e-9));
}
