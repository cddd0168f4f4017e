// Smooth surfaces: what is reflected and refracted, how lanes part at a dispersive boundary, and
// that nothing is lost.
#include <catch2/catch.hpp>

#include "core/random.h"
#include "optics/material/fresnel.h"
#include "surface_fixture.h"

using namespace lucerna;
using namespace lucerna::optics;
using namespace lucerna::test;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

Surface glass(const Lanes& index) {
    Surface surface;
    surface.index_below = index;
    surface.dispersive = (index != index[0]).any();
    surface.add(SmoothDielectric{});
    return surface;
}

/// Expectation over u_lobe of the weight of each lane times g(wi), by many equidistant numbers.
template <typename Function>
Lanes expectation(const Surface& surface, const Vec3& wo, Transport transport, Function g) {
    constexpr int count = 20000;
    Eigen::Array<double, spectral::lane_count, 1> sum;
    sum.setZero();
    for (int i = 0; i < count; ++i) {
        const auto event =
            sample(surface.bsdf(), surface.at(), wo, (i + 0.5) / count, 0.5, 0.5, transport);
        if (event) sum += event->weight.cast<double>() * g(event->wi);
    }
    return (sum / count).cast<float>();
}

}  // namespace

TEST_CASE("A mirror reflects its reflectance on either side", "[unit]") {
    Surface surface;
    surface.add(Mirror{surface.spectrum(ramp(0.2, 0.9))});
    const Vec3 wo = direction(GENERATE(20.0, 150.0), 10.0);
    const auto event = sample(surface.bsdf(), surface.at(), wo, 0.3, 0.1, 0.2, Transport::flux);
    REQUIRE(event);
    CHECK(event->specular);
    CHECK(event->wi == Vec3(-wo.x(), -wo.y(), wo.z()));
    CHECK((event->weight == surface.spectra[0]).all());
    CHECK((evaluate(surface.bsdf(), surface.at(), wo, event->wi, Transport::flux) == 0.0f).all());
    CHECK(pdf_solid_angle(surface.bsdf(), surface.at(), wo, event->wi, Transport::flux) == 0.0);
}

TEST_CASE("A smooth metal in water reflects by its index relative to water", "[unit]") {
    Surface surface;
    surface.index_above = lanes(1.33);
    surface.add(SmoothConductor{surface.spectrum(lanes(0.2)), surface.spectrum(lanes(3.0))});
    const auto weight = [&](const Vec3& wo) {
        return static_cast<double>(
            sample(surface.bsdf(), surface.at(), wo, 0.5, 0.5, 0.5, Transport::flux)->weight[3]);
    };
    CHECK_THAT(
        weight(direction(40.0, 0.0)),
        WithinAbs(
            fresnel_conductor(std::cos(40.0 * pi / 180.0), 0.2 / 1.33, 3.0 / 1.33).unpolarised(),
            1e-6));
    CHECK_THAT(
        weight(direction(140.0, 0.0)),
        WithinAbs(fresnel_conductor(std::cos(40.0 * pi / 180.0), 0.2, 3.0).unpolarised(), 1e-6));
}

TEST_CASE("A lossless boundary without dispersion has the weight 1", "[unit]") {
    const Surface surface = glass(lanes(1.5));
    const Vec3 wo = direction(GENERATE(0.0, 35.0, 89.9, 91.0, 130.0, 170.0), 25.0);
    const double u = GENERATE(0.001, 0.5, 0.999);
    const auto event = sample(surface.bsdf(), surface.at(), wo, u, 0.5, 0.5, Transport::flux);
    REQUIRE(event);
    CHECK((event->weight - 1.0f).abs().maxCoeff() < 1e-6f);
    CHECK(event->specular);
    CHECK_FALSE(event->hero_only);
}

TEST_CASE("Total reflection has the weight 1 to the last bit", "[unit]") {
    Surface surface = glass(GENERATE(lanes(1.5), ramp(1.48, 1.53)));
    const Vec3 wo = direction(GENERATE(91.0, 120.0), 25.0);  // from inside, beyond 41.8 deg
    const auto event = sample(surface.bsdf(), surface.at(), wo, 0.9999, 0.5, 0.5,
                              GENERATE(Transport::flux, Transport::radiance));
    REQUIRE(event);
    CHECK((event->weight == 1.0f).all());
    CHECK(event->wi.z() == wo.z());
}

TEST_CASE("Refraction scales radiance by (n_wo / n_wi)^2 and flux not at all", "[unit]") {
    const Surface surface = glass(lanes(1.5));
    const double theta = GENERATE(30.0, 170.0);
    const double ratio = theta < 90.0 ? 1.0 / 1.5 : 1.5;
    const Vec3 wo = direction(theta, 0.0);
    const auto radiance =
        sample(surface.bsdf(), surface.at(), wo, 0.999, 0.5, 0.5, Transport::radiance);
    const auto flux = sample(surface.bsdf(), surface.at(), wo, 0.999, 0.5, 0.5, Transport::flux);
    CHECK(radiance->wi.z() * wo.z() < 0.0);
    CHECK_THAT(static_cast<double>(radiance->weight[0]), WithinRel(ratio * ratio, 1e-6));
    CHECK_THAT(static_cast<double>(flux->weight[0]), WithinRel(1.0, 1e-6));
}

TEST_CASE("Equal indices let light pass straight, at grazing incidence too", "[unit]") {
    Surface surface = glass(lanes(1.0));
    const Vec3 wo = direction(GENERATE(0.0, 45.0, 89.9999, 135.0), 10.0);
    const auto event = sample(surface.bsdf(), surface.at(), wo, 0.0, 0.5, 0.5, Transport::radiance);
    REQUIRE(event);
    CHECK(event->wi == -wo);
    CHECK((event->weight == 1.0f).all());
}

TEST_CASE("Every lane of a dispersive boundary is right in the mean over heroes", "[property]") {
    Surface surface = glass(ramp(1.46, 1.60));
    // From above; from below before, across (some lanes totally reflected), and beyond the critical
    // angles of 38.7 to 43.2 deg.
    const Vec3 wo = direction(GENERATE(50.0, 160.0, 180.0 - 41.0, 180.0 - 60.0), 0.0);
    const auto g = [](const Vec3& w) { return 1.0 + w.x() + 0.3 * w.z(); };
    const Transport transport = GENERATE(Transport::radiance, Transport::flux);
    Lanes mean = Lanes::Zero();
    for (int hero = 0; hero < spectral::lane_count; ++hero) {
        surface.hero = hero;
        mean += expectation(surface, wo, transport, g) / spectral::lane_count;
    }
    const bool above = wo.z() > 0.0;
    for (int k = 0; k < spectral::lane_count; ++k) {
        const auto n = static_cast<double>(surface.index_below[k]);
        const double eta = above ? n : 1.0 / n;
        const double r = fresnel_dielectric(std::abs(wo.z()), eta).unpolarised();
        double expected = r * g(Vec3(-wo.x(), -wo.y(), wo.z()));
        if (r < 1.0) {
            const double sin_t = wo.x() / eta;
            const Vec3 wi(-sin_t, 0.0, std::copysign(std::sqrt(1.0 - sin_t * sin_t), -wo.z()));
            expected +=
                (1.0 - r) * g(wi) * (transport == Transport::radiance ? 1.0 / (eta * eta) : 1.0);
        }
        INFO("lane " << k);
        // The equidistant u_lobe resolve a probability to 5e-5, which the hero's weight amplifies.
        CHECK_THAT(static_cast<double>(mean[k]), WithinAbs(expected, 4e-4));
    }
}

TEST_CASE("Behind a dispersive refraction the hero goes on alone, with 16 times its weight",
          "[unit]") {
    Surface surface = glass(ramp(1.46, 1.60));
    const Vec3 wo = direction(30.0, 0.0);
    const auto first = sample(surface.bsdf(), surface.at(), wo, 0.99, 0.5, 0.5, Transport::flux);
    REQUIRE(first);
    CHECK(first->hero_only);
    CHECK((first->weight > 0.0f).count() == 1);
    CHECK_THAT(static_cast<double>(first->weight[5]), WithinRel(16.0, 1e-2));
    surface.hero_only = true;
    const auto second = sample(surface.bsdf(), surface.at(), wo, 0.99, 0.5, 0.5, Transport::flux);
    CHECK_FALSE(second->hero_only);
    CHECK_THAT(static_cast<double>(second->weight[5]), WithinRel(1.0, 1e-6));
    const auto reflected = sample(surface.bsdf(), surface.at(), wo, 0.0, 0.5, 0.5, Transport::flux);
    CHECK_THAT(static_cast<double>(reflected->weight[5]), WithinRel(1.0, 1e-6));
}

TEST_CASE("A slab between two boundaries transmits (1 - R) / (1 + R)", "[statistical]") {
    // Unpolarised at each boundary, without absorption: T = (1-R)^2 (1 + R^2 + R^4 ...).
    Surface top = glass(lanes(1.52));
    Surface bottom = glass(lanes(1.0));
    bottom.index_above = lanes(1.52);
    const double theta = GENERATE(0.0, 45.0, 75.0);
    const double r = fresnel_dielectric(std::cos(theta * pi / 180.0), 1.52).unpolarised();
    RandomStream random(3, 0, RandomPurpose::test, 0);
    constexpr int count = 200'000;
    int transmitted = 0;
    for (int i = 0; i < count; ++i) {
        Vec3 wo = direction(theta, 0.0);
        for (bool at_top = true;; at_top = !at_top) {
            const Surface& surface = at_top ? top : bottom;
            const auto event = sample(surface.bsdf(), surface.at(), wo, random.uniform(), 0.5, 0.5,
                                      Transport::flux);
            wo = -event->wi;
            if (at_top && event->wi.z() > 0.0) break;
            if (!at_top && event->wi.z() < 0.0) {
                CHECK_THAT(event->wi.z(), WithinAbs(-std::cos(theta * pi / 180.0), 1e-9));
                ++transmitted;
                break;
            }
        }
    }
    const double expected = (1.0 - r) / (1.0 + r);
    const double error = std::sqrt(expected * (1.0 - expected) / count);
    CHECK_THAT(static_cast<double>(transmitted) / count, WithinAbs(expected, 4.9 * error));
    // Twin: without reflections between the boundaries the difference is found.
    if (theta > 50.0) {
        CHECK(std::abs(static_cast<double>(transmitted) / count - (1.0 - r) * (1.0 - r)) >
              4.9 * error);
    }
}
