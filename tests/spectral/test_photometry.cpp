#include "spectral/photometry.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <stdexcept>

#include "spectral/illuminants.h"
#include "spectral/observer.h"
#include "tests/spectral/reference_table.h"

using namespace lucerna::spectral;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

TEST_CASE("The observer is the one of the CIE tables", "[unit]") {
    const auto cmf = reference_table("cie1931_2deg_cmf_1nm.csv");
    REQUIRE(cmf.at("xbar").size() == 471);
    for (int nm = 360; nm <= 830; ++nm) {
        CHECK(x_bar().at(nm) == cmf.at("xbar").at(nm));
        CHECK(z_bar().at(nm) == cmf.at("zbar").at(nm));
        // y-bar is printed with fewer digits than V
        CHECK_THAT(v_lambda().at(nm), WithinRel(cmf.at("ybar").at(nm), 1e-6));
    }
    CHECK(v_lambda().at(555.0) == 1.0);
    CHECK(v_lambda().at(359.0) == 0.0);
    CHECK(v_lambda().at(831.0) == 0.0);
}

TEST_CASE("Luminous flux of a narrow band at 555 nm is 683 lm per watt", "[analytic]") {
    // One watt over 0.02 nm; V bends by less than 1e-4 within.
    const Spectrum line({554.99, 555.0, 555.01}, {0.0, 100.0, 0.0}, Outside::zero);
    CHECK_THAT(luminous(line), WithinRel(683.002, 1e-5));
    // The defining constant: 683 lm/W exactly at 540e12 Hz, 555.017 nm in air.
    const Spectrum definition({555.007, 555.017, 555.027}, {0.0, 100.0, 0.0}, Outside::zero);
    CHECK_THAT(luminous(definition), WithinRel(683.0, 1e-5));
}

TEST_CASE("Luminous flux of an equal-energy spectrum is K_m times the area of V", "[analytic]") {
    // Area of V at 1 nm from 360 to 830 nm: 106.857 nm (Wyszecki and Stiles, table I(3.3.1)).
    CHECK_THAT(luminous(Spectrum(1.0)), WithinRel(683.002 * 106.857, 2e-6));
}

TEST_CASE("A black body at the freezing point of platinum has 60 cd/cm2", "[analytic]") {
    // The candela of 1948 to 1979; 683 lm/W was chosen so that it stayed (CIPM 1977), with
    // 2042 K on the temperature scale of that time. One kelvin is 0.6 %.
    CHECK_THAT(luminous(planck(2042.0)), WithinRel(60e4, 5e-3));
}

TEST_CASE("Flux does not depend on the grid of the same function", "[property]") {
    const Spectrum coarse({450.0, 550.0, 700.0}, {0.2, 1.0, 0.1}, Outside::zero);
    std::vector<double> wavelengths_nm;
    std::vector<double> values;
    for (double nm = 450.0; nm <= 700.0; nm += 0.25) {
        wavelengths_nm.push_back(nm);
        values.push_back(coarse.at(nm));
    }
    const Spectrum fine(wavelengths_nm, values, Outside::zero);
    CHECK_THAT(luminous(fine), WithinRel(luminous(coarse), 1e-12));
    // and not by accident: other values give another flux
    values[400] *= 1.01;
    const Spectrum bent(wavelengths_nm, values, Outside::zero);
    CHECK(std::abs(luminous(bent) / luminous(coarse) - 1.0) > 1e-6);
}

TEST_CASE("A relative spectrum is scaled to a luminous flux", "[property]") {
    const char* name = GENERATE("A", "D65", "FL11", "LED-B3", "HP1");
    const Spectrum relative = *illuminant(name);
    const Spectrum flux = scaled_to_luminous(relative, 1200.0);
    CHECK_THAT(luminous(flux), WithinRel(1200.0, 1e-13));
    CHECK_THAT(flux.at(600.0) / flux.at(500.0),
               WithinRel(relative.at(600.0) / relative.at(500.0), 1e-13));
    CHECK(luminous(scaled_to_luminous(relative, 0.0)) == 0.0);
}

TEST_CASE("A spectrum without light cannot be given a luminous flux", "[unit]") {
    const Spectrum infrared({850.0, 950.0}, {1.0, 1.0}, Outside::zero);
    CHECK_THROWS_AS(scaled_to_luminous(infrared, 100.0), std::invalid_argument);
    CHECK_THROWS_AS(scaled_to_luminous(Spectrum(0.0), 100.0), std::invalid_argument);
    CHECK_THROWS_AS(scaled_to_luminous(Spectrum(1.0), -1.0), std::invalid_argument);
    CHECK_THROWS_AS(luminous_efficacy_of_radiation(infrared), std::invalid_argument);
}

TEST_CASE("Luminous efficacy of radiation counts what is radiated from 360 to 830 nm", "[unit]") {
    const Spectrum line({554.99, 555.0, 555.01}, {0.0, 7.0, 0.0}, Outside::zero);
    CHECK_THAT(luminous_efficacy_of_radiation(line), WithinRel(683.002, 1e-5));
    CHECK_THAT(luminous_efficacy_of_radiation(Spectrum(2.0)),
               WithinRel(683.002 * 106.857 / 470.0, 2e-6));
}
