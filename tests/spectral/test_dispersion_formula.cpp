#include "spectral/dispersion_formula.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <stdexcept>

using namespace lucerna::spectral;
using Catch::Contains;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

struct Expected {
    DispersionFormula formula;
    double wavelength_nm;
    double index;
};

// Computed apart from the library, from the definitions of the database, with 40 decimal digits.
const std::vector<Expected> expected_indices = {
    // SiO2, Malitson
    {{1, {0, 0.6961663, 0.0684043, 0.4079426, 0.1162414, 0.8974794, 9.896161}},
     587.6,
     1.458462342053240860},
    {{1, {0, 0.6961663, 0.0684043, 0.4079426, 0.1162414, 0.8974794, 9.896161}},
     500.0,
     1.462326486700377878},
    // N-BK7
    {{2, {0, 1.03961212, 0.00600069867, 0.231792344, 0.0200179144, 1.01046945, 103.560653}},
     650.0,
     1.514520308564779603},
    // PMMA, Beadie
    {{3,
      {2.1778, 6.1209e-3, 2, -1.5004e-3, 4, 2.3678e-2, -2, -4.2137e-3, -4, 7.3417e-4, -6,
       -4.5042e-5, -8}},
     500.0,
     1.497326076043558389},
    // TiO2, Devore
    {{4, {5.913, 0.2441, 0, 0.0803, 1, 0, 0, 0, 1}}, 587.6, 2.614234743468797921},
    // every kind of term of formula 4, made up
    {{4, {2.2, 0.01, 2, 0.02, 1.5, 0.3, 1, 0.5, 2, 0.004, -2, -0.001, 4}},
     600.0,
     1.964032672097660490},
    // SiC, Shaffer
    {{5, {2.5538, 0.0342, -2}}, 500.0, 2.6906},
    // NH3, Cuthbertson
    {{6, {0, 0.032953, 90.392}}, 500.0, 1.000381435781090842},
    // made up
    {{7, {1.5, 0.004, -0.00003, -0.01, 0.002, -0.0004}}, 500.0, 1.515028051193084977},
    {{7, {1.5, 0.004, -0.00003, -0.01, 0.002, -0.0004}}, 650.0, 1.506048497345837640},
    // AgBr, Schroeter
    {{8, {0.452505, 0.09939, 0.070537, -0.000150}}, 587.6, 2.257931854568737529},
    // urea, extraordinary ray, Rosker
    {{9, {2.51527, 0.0240, 0.0300, 0.020, 1.52, 0.8771}}, 587.6, 1.606460948336237114},
};

}  // namespace

TEST_CASE("Each dispersion formula gives the index by its definition", "[unit]") {
    const Expected row = GENERATE(from_range(expected_indices));
    INFO("formula " << row.formula.number << " at " << row.wavelength_nm << " nm");
    CHECK(row.formula.problem().empty());
    CHECK_THAT(row.formula.index_at(row.wavelength_nm), WithinRel(row.index, 1e-14));
    // Twin: another formula with the same coefficients gives something else.
    DispersionFormula other = row.formula;
    other.number = row.formula.number == 3 ? 5 : 3;
    if (other.problem().empty()) {
        CHECK(std::abs(other.index_at(row.wavelength_nm) - row.index) > 1e-4);
    }
}

TEST_CASE("A tabulated formula follows the formula to better than 1e-6", "[property]") {
    // SF11, the steepest glass here; its own range begins at 390 nm.
    const DispersionFormula sf11{
        2, {0, 1.73848403, 0.0136068604, 0.311168974, 0.0615960463, 1.17490871, 121.922711}};
    const Spectrum table = sf11.tabulated(360.0, 830.0);
    double worst = 0.0;
    for (double nm = 360.0; nm <= 830.0; nm += 0.037) {
        const double q = 1e-6 * nm * nm;
        const double n =
            std::sqrt(1.0 + 1.73848403 * q / (q - 0.0136068604) +
                      0.311168974 * q / (q - 0.0615960463) + 1.17490871 * q / (q - 121.922711));
        worst = std::max(worst, std::abs(table.at(nm) - n));
    }
    CHECK(worst < 3e-7);
    CHECK(worst > 1e-9);  // it is a table
}

TEST_CASE("A table of a formula has the ends of its range", "[unit]") {
    const Spectrum table = DispersionFormula{5, {1.5, 0.01, -2}}.tabulated(436.8, 705.25);
    CHECK(table.wavelengths_nm().front() == 436.8);
    CHECK(table.wavelengths_nm().back() == 705.25);
    CHECK(table.outside() == Outside::hold);
    CHECK_THAT(table.at(436.8), WithinRel(1.5 + 0.01 / (0.4368 * 0.4368), 1e-14));
}

TEST_CASE("A pole of a formula is found", "[unit]") {
    const DispersionFormula negative{1, {0, 1.0, 0.5}};  // n^2 < 0 below 500 nm
    CHECK_THROWS_AS(negative.tabulated(400.0, 700.0), std::domain_error);
    CHECK(std::isnan(negative.index_at(450.0)));
    const DispersionFormula between{5, {1.5, 1e-9, -2}};
    CHECK_NOTHROW(between.tabulated(400.0, 700.0));
    // A pole between the nodes of the table: n^2 = 3 + tiny / (lambda^2 - 0.5005^2)
    const DispersionFormula pole{9, {3.0, 1e-4, 0.5005 * 0.5005, 0, 0, 1}};
    CHECK_THROWS_AS(pole.tabulated(400.0, 700.0), std::domain_error);
}

TEST_CASE("A wrong number of coefficients is named", "[unit]") {
    CHECK_THAT((DispersionFormula{1, {0, 1}}.problem()), Contains("2 coefficients"));
    CHECK_THAT((DispersionFormula{4, {1, 2, 3}}.problem()), Contains("expected 1, 5 or 9"));
    CHECK_THAT((DispersionFormula{7, {}}.problem()), Contains("expected 1 to 6"));
    CHECK_THAT((DispersionFormula{8, {1, 2, 3}}.problem()), Contains("expected 4"));
    CHECK_THAT((DispersionFormula{9, {1, 2, 3}}.problem()), Contains("expected 6"));
    CHECK_THAT((DispersionFormula{10, {1}}.problem()), Contains("expected 1 to 9"));
}
