#include <catch2/catch.hpp>
#include <stdexcept>

#include "io/quantity.h"

using namespace lucerna::io;
using Catch::Matchers::WithinRel;

namespace {

std::string complaint(const std::string& text, const Dimension& dimension) {
    try {
        parse_quantity(text, dimension);
        return "";
    } catch (const std::invalid_argument& error) {
        return error.what();
    }
}

}  // namespace

TEST_CASE("Quantities are read in their base unit", "[unit]") {
    CHECK_THAT(parse_value("10 mm", dimension::length), WithinRel(0.010, 1e-15));
    CHECK_THAT(parse_value("10mm", dimension::length), WithinRel(0.010, 1e-15));
    CHECK_THAT(parse_value(" +2.5e3 um ", dimension::length), WithinRel(0.0025, 1e-15));
    CHECK_THAT(parse_value("-3 cm", dimension::length), WithinRel(-0.03, 1e-15));
    CHECK_THAT(parse_value("180 deg", dimension::angle), WithinRel(3.14159265358979324, 1e-15));
    CHECK_THAT(parse_value("0.5 1/cm", dimension::absorption), WithinRel(50.0, 1e-15));
    CHECK_THAT(parse_value("2 1/mm", dimension::absorption), WithinRel(2000.0, 1e-15));
    CHECK_THAT(parse_value("1.5 h", dimension::time), WithinRel(5400.0, 1e-15));
    CHECK_THAT(parse_value("2%", dimension::percent), WithinRel(0.02, 1e-15));
    CHECK_THAT(parse_value("2 %", dimension::fraction), WithinRel(0.02, 1e-15));
    CHECK_THAT(parse_value("0.02", dimension::fraction), WithinRel(0.02, 1e-15));
    CHECK_THAT(parse_value("0.55 um", dimension::wavelength), WithinRel(550.0, 1e-15));
}

TEST_CASE("The base unit tells photometric from radiometric quantities", "[unit]") {
    CHECK(parse_quantity("2 klm", dimension::flux).base == "lm");
    CHECK(parse_quantity("2 klm", dimension::flux).value == 2000.0);
    CHECK(parse_quantity("3 W", dimension::flux).base == "W");
    CHECK(parse_quantity("1 cd/m^2", dimension::luminance).base == "cd/m2");
    CHECK(parse_quantity("1 cd/m²", dimension::luminance).base == "cd/m2");
    CHECK(parse_quantity("7 W/(m2 sr)", dimension::luminance).base == "W/(m2 sr)");
    CHECK(parse_quantity("5 lx", dimension::irradiance).base == "lx");
}

TEST_CASE("A complaint names what was found and what would be accepted", "[unit]") {
    CHECK(complaint("1200", dimension::luminous_flux) ==
          "'1200' has no unit; expected a luminous flux such as \"1200 lm\"");
    CHECK(complaint("10 deg", dimension::length) ==
          "'10 deg' has the unit 'deg', not m, mm, cm, um or km; expected a length such as \"10 "
          "mm\"");
    CHECK(complaint("1 lx", dimension::luminance).find("'lx', not cd/m2") != std::string::npos);
    CHECK(complaint("1 lm", dimension::number).find("has the unit 'lm'") != std::string::npos);
    CHECK(complaint("0.02", dimension::percent).find("has no unit") != std::string::npos);
}

TEST_CASE("What is not a finite number is refused", "[unit]") {
    CHECK(complaint("ten mm", dimension::length).find("is not a number") != std::string::npos);
    CHECK(complaint("", dimension::length).find("is empty") != std::string::npos);
    CHECK(complaint("mm", dimension::length).find("is not a number") != std::string::npos);
    CHECK(complaint("- 3 mm", dimension::length).find("is not a number") != std::string::npos);
    CHECK(complaint("+-3 mm", dimension::length) != "");
    CHECK(complaint("nan mm", dimension::length).find("is not finite") != std::string::npos);
    CHECK(complaint("inf mm", dimension::length).find("is not finite") != std::string::npos);
    CHECK(complaint(".inf", dimension::number).find("is not a number") != std::string::npos);
    CHECK(complaint("1e999 mm", dimension::length).find("too large") != std::string::npos);
    CHECK(complaint("1e308 km", dimension::length).find("too large") != std::string::npos);
    CHECK(complaint("1,5 m", dimension::length).find("decimal comma") != std::string::npos);
    CHECK(complaint("0x10 mm", dimension::length).find("has the unit") != std::string::npos);
    CHECK(complaint(std::string(100000, '7') + " mm", dimension::length).size() < 200);
}

TEST_CASE("A value may be stated with its uncertainty", "[unit]") {
    const auto check = [](const char* text, const Dimension& dimension, double value,
                          double uncertainty) {
        const UncertainQuantity read = parse_uncertain_quantity(text, dimension);
        INFO(text);
        CHECK_THAT(read.quantity.value, WithinRel(value, 1e-12));
        REQUIRE(read.expanded_uncertainty);
        CHECK_THAT(*read.expanded_uncertainty, WithinRel(uncertainty, 1e-12));
    };
    check("0.7 ± 0.02", dimension::fraction, 0.7, 0.02);
    check("70 % ± 2 %", dimension::fraction, 0.7, 0.02);  // of a fraction: points
    check("0.7 +/- 2 %", dimension::fraction, 0.7, 0.02);
    check("1.2 klm ± 60 lm", dimension::luminous_flux, 1200.0, 60.0);
    check("1200 lm±5%", dimension::luminous_flux, 1200.0, 60.0);  // else of the value
    check("-4 mm ± 50 %", dimension::length, -4e-3, 2e-3);
    CHECK_FALSE(parse_uncertain_quantity("0.7", dimension::fraction).expanded_uncertainty);
    for (const char* wrong : {"0.7 ±", "± 0.1", "0.7 ± -0.1", "0.7 ± 1 lm", "0.7 ± 0.1 ± 0.1"}) {
        INFO(wrong);
        CHECK_THROWS_AS(parse_uncertain_quantity(wrong, dimension::fraction),
                        std::invalid_argument);
    }
    CHECK_THROWS_AS(parse_uncertain_quantity("5 lm ± 1 W", dimension::flux), std::invalid_argument);
}
