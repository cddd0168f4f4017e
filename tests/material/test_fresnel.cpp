// Fresnel's equations against closed forms and against their complex amplitude form.
#include <catch2/catch.hpp>
#include <complex>

#include "optics/material/fresnel.h"
#include "surface_fixture.h"

using namespace lucerna;
using namespace lucerna::optics;
using namespace lucerna::test;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

/// Amplitude form with complex cosines (Hecht, Optics, 5th ed., eqs. 4.34 and 4.40), which shares
/// no algebra with the code under test.
FresnelReflectance by_amplitudes(double cos_i, std::complex<double> eta) {
    const std::complex<double> cos_t = std::sqrt(1.0 - (1.0 - cos_i * cos_i) / (eta * eta));
    const auto rs = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
    const auto rp = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
    return {std::norm(rs), std::norm(rp)};
}

}  // namespace

TEST_CASE("Fresnel reflectance of glass at normal incidence is ((n - 1) / (n + 1))^2", "[unit]") {
    const double n = GENERATE(1.33, 1.5, 2.4);
    const double r = (n - 1.0) / (n + 1.0);
    CHECK_THAT(fresnel_dielectric(1.0, n).s, WithinRel(r * r, 1e-14));
    CHECK_THAT(fresnel_dielectric(1.0, n).p, WithinRel(r * r, 1e-14));
    CHECK_THAT(fresnel_dielectric(1.0, 1.0 / n).unpolarised(), WithinRel(r * r, 1e-14));
}

TEST_CASE("At Brewster's angle no parallel light is reflected", "[unit]") {
    const double n = 1.52;
    const double cos_brewster = std::cos(std::atan(n));
    CHECK_THAT(fresnel_dielectric(cos_brewster, n).p, WithinAbs(0.0, 1e-30));
    // sin^2(theta_i - theta_t) with theta_i + theta_t = 90 deg: ((n^2 - 1) / (n^2 + 1))^2
    const double rs = (n * n - 1.0) / (n * n + 1.0);
    CHECK_THAT(fresnel_dielectric(cos_brewster, n).s, WithinRel(rs * rs, 1e-13));
}

TEST_CASE("Beyond the critical angle everything is reflected", "[unit]") {
    const double eta = 1.0 / 1.5;
    const double critical = std::asin(eta);
    CHECK(fresnel_dielectric(std::cos(critical + 1e-6), eta).unpolarised() == 1.0);
    CHECK(fresnel_dielectric(std::cos(critical - 1e-6), eta).unpolarised() < 1.0);
    CHECK(fresnel_dielectric(0.0, eta).unpolarised() == 1.0);
    CHECK(fresnel_dielectric(0.0, 1.5).unpolarised() == 1.0);
}

TEST_CASE("A boundary between equal indices reflects nothing at any angle", "[unit]") {
    CHECK(fresnel_dielectric(GENERATE(0.0, 1e-9, 0.5, 1.0), 1.0).unpolarised() == 0.0);
}

TEST_CASE("Fresnel reflectances agree with the amplitude form", "[unit]") {
    const double cos_i = GENERATE(1e-6, 0.05, 0.3, 0.7, 0.99, 1.0);
    SECTION("dielectric") {
        const double eta = GENERATE(0.6, 0.9, 1.1, 1.5, 2.4);
        const auto expected = by_amplitudes(cos_i, eta);
        CHECK_THAT(fresnel_dielectric(cos_i, eta).s, WithinRel(expected.s, 1e-10));
        CHECK_THAT(fresnel_dielectric(cos_i, eta).p, WithinAbs(expected.p, 1e-10));
    }
    SECTION("conductor") {
        const auto [n, k] = GENERATE(table<double, double>(
            {{0.05, 3.5}, {1.5, 0.0}, {1.5, 1e-6}, {2.8, 3.3}, {0.2, 0.1}, {1.0, 6.0}}));
        const auto expected = by_amplitudes(cos_i, {n, k});
        CHECK_THAT(fresnel_conductor(cos_i, n, k).s, WithinRel(expected.s, 1e-9));
        CHECK_THAT(fresnel_conductor(cos_i, n, k).p, WithinAbs(expected.p, 1e-9));
    }
}

TEST_CASE("Silver reflects 98 % of green light", "[unit]") {
    // n + ik of Johnson and Christy, Phys. Rev. B 6, 4370 (1972), table I, at 2.26 eV (548.6 nm).
    const double n = 0.06, k = 3.586;
    const double closed = ((n - 1) * (n - 1) + k * k) / ((n + 1) * (n + 1) + k * k);
    CHECK_THAT(fresnel_conductor(1.0, n, k).unpolarised(), WithinRel(closed, 1e-13));
    CHECK_THAT(closed, WithinAbs(0.983, 0.001));
}

TEST_CASE("Refraction obeys Snell's law and passes straight through equal indices", "[unit]") {
    const Vec3 wo = direction(GENERATE(0.0, 20.0, 60.0, 89.0), 40.0);
    const double eta = GENERATE(0.999, 1.5, 2.0);
    const Vec3 wi = refract(wo, Vec3::UnitZ(), eta);
    if (wi.z() != 0.0) {
        CHECK_THAT(wi.head<2>().norm() * eta, WithinAbs(wo.head<2>().norm(), 1e-12));
    }
    CHECK(wi.z() <= 0.0);
    CHECK_THAT(wi.norm(), WithinRel(1.0, 1e-14));
    CHECK(refract(wo, Vec3::UnitZ(), 1.0) == -wo);
}

TEST_CASE("Lanes carry the values of the single wavelengths", "[unit]") {
    const Lanes eta = ramp(0.5, 2.0);
    const Lanes r = fresnel_dielectric(0.4, eta);
    const Lanes metal = fresnel_conductor(0.4, eta, ramp(0.0, 4.0));
    for (int k = 0; k < spectral::lane_count; ++k) {
        const auto e = static_cast<double>(eta[k]);
        CHECK_THAT(static_cast<double>(r[k]),
                   WithinAbs(fresnel_dielectric(0.4, e).unpolarised(), 1e-7));
        CHECK_THAT(static_cast<double>(metal[k]),
                   WithinAbs(fresnel_conductor(0.4, e, 4.0 * k / 15.0).unpolarised(), 1e-6));
    }
}
