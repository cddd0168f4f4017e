#include <catch2/catch.hpp>
#include <limits>
#include <stdexcept>

#include "spectral/integral.h"
#include "spectral/spectrum.h"

using namespace lucerna::spectral;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

TEST_CASE("A spectrum is interpolated linearly", "[unit]") {
    const Spectrum spectrum({400.0, 500.0, 520.0}, {1.0, 3.0, 2.0}, Outside::hold);
    CHECK(spectrum.at(400.0) == 1.0);
    CHECK_THAT(spectrum.at(425.0), WithinRel(1.5, 1e-15));
    CHECK(spectrum.at(500.0) == 3.0);
    CHECK_THAT(spectrum.at(515.0), WithinRel(2.25, 1e-15));
    CHECK(spectrum.at(520.0) == 2.0);
}

TEST_CASE("Outside of its table a spectrum is held or zero", "[unit]") {
    const Spectrum held({400.0, 500.0}, {1.0, 3.0}, Outside::hold);
    CHECK(held.at(360.0) == 1.0);
    CHECK(held.at(830.0) == 3.0);
    const Spectrum zero({400.0, 500.0}, {1.0, 3.0}, Outside::zero);
    CHECK(zero.at(399.999) == 0.0);
    CHECK(zero.at(400.0) == 1.0);
    CHECK(zero.at(500.0) == 3.0);
    CHECK(zero.at(500.001) == 0.0);
}

TEST_CASE("Extremes of a spectrum are those of the simulated range", "[unit]") {
    const Spectrum wide({260.0, 460.0, 500.0, 930.0}, {0.0, 4.0, 1.0, 9.6}, Outside::hold);
    CHECK_THAT(wide.min(), WithinRel(1.0, 1e-14));
    CHECK_THAT(wide.max(), WithinRel(1.0 + 8.6 * 330.0 / 430.0, 1e-14));  // its value at 830 nm
    const Spectrum band({450.0, 500.0}, {2.0, 3.0}, Outside::zero);
    CHECK(band.min() == 0.0);
    CHECK(band.max() == 3.0);
    const Spectrum infrared({900.0, 1000.0}, {2.0, 3.0}, Outside::zero);
    CHECK(infrared.max() == 0.0);
    CHECK(Spectrum(0.25).min() == 0.25);
    CHECK(Spectrum(0.25).max() == 0.25);
}

TEST_CASE("A spectrum is scaled in all its values", "[unit]") {
    const Spectrum scaled = Spectrum({400.0, 500.0}, {1.0, 3.0}, Outside::zero).scaled(2.0);
    CHECK(scaled.at(450.0) == 4.0);
    CHECK(scaled.at(600.0) == 0.0);
    CHECK(Spectrum(0.5).scaled(3.0).at(555.0) == 1.5);
}

TEST_CASE("A table that is no function of wavelength is refused", "[unit]") {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_AS(Spectrum({}, {}, Outside::hold), std::invalid_argument);
    CHECK_THROWS_AS(Spectrum({400.0, 500.0}, {1.0}, Outside::hold), std::invalid_argument);
    CHECK_THROWS_AS(Spectrum({500.0, 500.0}, {1.0, 2.0}, Outside::hold), std::invalid_argument);
    CHECK_THROWS_AS(Spectrum({500.0, 400.0}, {1.0, 2.0}, Outside::hold), std::invalid_argument);
    CHECK_THROWS_AS(Spectrum({400.0, 500.0}, {1.0, nan}, Outside::hold), std::invalid_argument);
    CHECK_THROWS_AS(Spectrum({400.0, nan}, {1.0, 1.0}, Outside::hold), std::invalid_argument);
    CHECK_THROWS_AS(Spectrum({400.0}, {1.0}, Outside::zero), std::invalid_argument);
    CHECK_THROWS_AS(Spectrum(nan), std::invalid_argument);
    CHECK(Spectrum({400.0}, {1.5}, Outside::hold).at(700.0) == 1.5);
}

TEST_CASE("Integrals of piecewise linear products are exact", "[unit]") {
    // integral of x (1 - x) over [0, 1] is 1/6; here x = (lambda - 500 nm) / 100 nm.
    const Spectrum up({500.0, 600.0}, {0.0, 1.0}, Outside::zero);
    const Spectrum down({450.0, 500.0, 600.0, 650.0}, {1.0, 1.0, 0.0, 0.0}, Outside::hold);
    CHECK_THAT(integral_of_product(up, down), WithinRel(100.0 / 6.0, 1e-13));
    // A jump to zero at the end of the table belongs to the table's side.
    const Spectrum box({500.0, 600.0}, {1.0, 1.0}, Outside::zero);
    CHECK_THAT(integral_of_product(box, 2.0), WithinRel(200.0, 1e-13));
    CHECK_THAT(integral_of_product(box, box, 550.0, 700.0), WithinRel(50.0, 1e-13));
    CHECK_THAT(integral_of_product(1.0, 1.0), WithinRel(470.0, 1e-13));
    CHECK_THAT(integral_of_product(box, 1.0, 610.0, 700.0), WithinAbs(0.0, 0.0));
}
