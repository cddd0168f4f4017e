#include "spectral/colorimetry.h"

#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <cmath>

#include "spectral/illuminants.h"
#include "spectral/photometry.h"

using namespace lucerna::spectral;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

Xyz colour_of(double x, double y) {
    return {x / y, 1.0, (1.0 - x - y) / y};
}

// A colour at a given place in (u, v) of 1960: x = 3u / (2u - 8v + 4), y = 2v / (2u - 8v + 4).
Xyz colour_of_uv(double u, double v) {
    const double d = 2.0 * u - 8.0 * v + 4.0;
    return colour_of(3.0 * u / d, 2.0 * v / d);
}

}  // namespace

TEST_CASE("Y is the luminous quantity", "[unit]") {
    const Spectrum spectrum = *illuminant("FL2");
    CHECK_THAT(tristimulus(spectrum).y, WithinRel(luminous(spectrum), 1e-14));
}

TEST_CASE("Chromaticity coordinates of D65", "[unit]") {
    const Xyz d65 = colour_of(0.31272, 0.32903);
    CHECK_THAT(chromaticity(d65)->x, WithinAbs(0.31272, 1e-12));
    CHECK_THAT(chromaticity(d65)->y, WithinAbs(0.32903, 1e-12));
    // u', v' as CIE 15:2004 prints them
    CHECK_THAT(chromaticity_1976(d65)->u, WithinAbs(0.19783, 1e-5));
    CHECK_THAT(chromaticity_1976(d65)->v, WithinAbs(0.46833, 1e-5));
    CHECK_THAT(chromaticity_1960(d65)->u, WithinAbs(0.19783, 1e-5));
    CHECK_THAT(chromaticity_1960(d65)->v, WithinAbs(0.46833 * 2.0 / 3.0, 1e-5));
}

TEST_CASE("Black has no colour", "[unit]") {
    CHECK_FALSE(chromaticity({}));
    CHECK_FALSE(chromaticity_1976({}));
    CHECK_FALSE(chromaticity_1960({}));
    CHECK_FALSE(correlated_colour_temperature({}));
}

TEST_CASE("A black body has its own temperature", "[property]") {
    const double temperature_k =
        GENERATE(1001.0, 1500.0, 2856.0, 4000.0, 6500.0, 12345.0, 20000.0, 50000.0, 99000.0);
    const auto found = correlated_colour_temperature(tristimulus(planck(temperature_k)));
    REQUIRE(found);
    CHECK_THAT(found->cct_k, WithinRel(temperature_k, 1e-4));
    CHECK_THAT(found->duv, WithinAbs(0.0, 1e-6));
}

TEST_CASE("Moving off the locus at a right angle keeps the temperature", "[property]") {
    const double temperature_k = GENERATE(2000.0, 3000.0, 6500.0, 15000.0);
    const double duv = GENERATE(-0.049, -0.02, -0.003, 0.003, 0.02, 0.049);
    const auto uv = [](double t) { return *chromaticity_1960(tristimulus(planck(t))); };
    const UniformChromaticity here = uv(temperature_k);
    const UniformChromaticity a = uv(temperature_k * 0.999);
    const UniformChromaticity b = uv(temperature_k * 1.001);
    const double length = std::hypot(b.u - a.u, b.v - a.v);
    const double across_u = (b.v - a.v) / length;
    const double across_v = -(b.u - a.u) / length;
    const double side = across_v > 0.0 ? duv : -duv;
    const auto found = correlated_colour_temperature(
        colour_of_uv(here.u + side * across_u, here.v + side * across_v));
    REQUIRE(found);
    CHECK_THAT(found->cct_k, WithinRel(temperature_k, 5e-4));
    CHECK_THAT(found->duv, WithinAbs(duv, 1e-5));
}

TEST_CASE("Temperature of the D illuminants", "[unit]") {
    // CIE 15:2018: 5003 K, 5503 K, 6504 K, 7504 K in round numbers; Duv of daylight about 0.0032
    for (const auto& [name, cct_k] :
         {std::pair{"D50", 5003.0}, {"D55", 5503.0}, {"D65", 6504.0}, {"D75", 7504.0}}) {
        const auto found = correlated_colour_temperature(tristimulus(*illuminant(name)));
        REQUIRE(found);
        CHECK_THAT(found->cct_k, WithinAbs(cct_k, 3.0));
        CHECK_THAT(found->duv, WithinAbs(0.0032, 1e-4));
    }
}

TEST_CASE("Colour temperature has no meaning for saturated colours", "[unit]") {
    CHECK_FALSE(correlated_colour_temperature(colour_of(0.20, 0.70)));  // green
    CHECK_FALSE(correlated_colour_temperature(colour_of(0.15, 0.06)));  // blue
    CHECK_FALSE(correlated_colour_temperature(colour_of(0.72, 0.27)));  // deep red
    CHECK_FALSE(correlated_colour_temperature(tristimulus(planck(900.0))));
}

TEST_CASE("Linear sRGB follows IEC 61966-2-1", "[unit]") {
    Eigen::Matrix3d printed;  // the matrix of the standard, rounded to four decimals
    printed << 3.2406, -1.5372, -0.4986, -0.9689, 1.8758, 0.0415, 0.0557, -0.2040, 1.0570;
    CHECK((linear_srgb_from_xyz() - printed).cwiseAbs().maxCoeff() < 5e-4);

    const Xyz white = colour_of(0.3127, 0.3290);
    const Eigen::Vector3d rgb = linear_srgb_from_xyz() * Eigen::Vector3d(white.x, white.y, white.z);
    CHECK((rgb - Eigen::Vector3d::Ones()).norm() < 1e-12);

    const Xyz green = colour_of(0.30, 0.60);
    const Eigen::Vector3d pure =
        linear_srgb_from_xyz() * Eigen::Vector3d(green.x, green.y, green.z);
    CHECK_THAT(pure.x(), WithinAbs(0.0, 1e-12));
    CHECK_THAT(pure.z(), WithinAbs(0.0, 1e-12));
    CHECK_THAT(1.0 / pure.y(), WithinRel(0.7152, 1e-4));  // luminance of the green primary
}
