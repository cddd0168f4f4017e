#include "io/spectrum_csv.h"

#include <catch2/catch.hpp>

#include "core/diagnostics.h"
#include "tests/spectral/text_file.h"

using namespace lucerna;
using Catch::Contains;
using Catch::Matchers::WithinRel;
using io::read_spectrum_csv;
using spectral::Outside;
using spectral::Spectrum;

namespace {

Spectrum spectrum_from_text(std::string_view text, std::string_view column = "") {
    return read_spectrum_csv(TextFile(text).path(), column, Outside::hold);
}

std::vector<std::string> complaints(std::string_view text, std::string_view column = "") {
    try {
        spectrum_from_text(text, column);
    } catch (const InputError& error) {
        std::vector<std::string> found;
        for (const Diagnostic& diagnostic : error.diagnostics()) {
            found.push_back(fmt::format("{}:{}: {}", diagnostic.where.line, diagnostic.where.column,
                                        diagnostic.message));
        }
        return found;
    }
    return {};
}

}  // namespace

TEST_CASE("A column of a table becomes a spectrum", "[unit]") {
    const char* text =
        "# measured on Monday\n"
        "\n"
        "wavelength_nm, wall, floor\n"
        "400, 0.5, 0.1\n"
        "# in between\n"
        "500, 0.7, 0.2\n"
        "600, +7e-1, .3";
    const Spectrum floor = spectrum_from_text(text, "floor");
    CHECK(floor.wavelengths_nm() == std::vector<double>{400.0, 500.0, 600.0});
    CHECK(floor.values() == std::vector<double>{0.1, 0.2, 0.3});
    CHECK(floor.outside() == Outside::hold);
    CHECK(spectrum_from_text(text, "wall").at(550.0) == 0.7);
}

TEST_CASE("Separators, line ends and units are recognised", "[unit]") {
    const char* text = GENERATE(
        "wavelength_nm,r\n400,0.5\n500,0.7\n", "Wavelength [nm];r\r\n400;0.5\r\n500;0.7\r\n",
        "nm\tr\n400\t0.5\n500\t0.7\n", "wavelength_um,r\n0.4,0.5\n0.5,0.7\n",
        "lambda (\xC2\xB5m),r\n0.4,0.5\n0.5,0.7\n", "wavelength [\xCE\xBCm],r\n0.4,0.5\n0.5,0.7\n",
        "\xEF\xBB\xBFwavelength_nm,r\n400,0.5\n500,0.7\n",
        "\"wavelength_nm\",\"r\"\n\"400\",\"0.5\"\n500,0.7\n");
    INFO(text);
    const Spectrum spectrum = spectrum_from_text(text, "r");
    CHECK_THAT(spectrum.wavelengths_nm()[0], WithinRel(400.0, 1e-14));
    CHECK_THAT(spectrum.wavelengths_nm()[1], WithinRel(500.0, 1e-14));
    CHECK(spectrum.values() == std::vector<double>{0.5, 0.7});
    CHECK(spectrum_from_text(text).values() == spectrum.values());  // the only column needs no name
}

TEST_CASE("A column may be shorter than the table", "[unit]") {
    const char* text = "wavelength_nm,a,b\n300,,1\n400,2,1\n500,3,1\n600,,1\n700,,1\n";
    const Spectrum a = spectrum_from_text(text, "a");
    CHECK(a.wavelengths_nm() == std::vector<double>{400.0, 500.0});
    CHECK(a.at(600.0) == 3.0);
    CHECK(
        complaints("nm,a\n300,1\n400,\n500,2\n", "a") ==
        std::vector<std::string>{"4:5: a value behind an empty cell; a column must have no gaps"});
}

TEST_CASE("The shipped CIE tables are such files", "[unit]") {
    const Spectrum d65 = read_spectrum_csv(
        LUCERNA_DATA_DIR "/colorimetry/cie_illuminants_standard.csv", "D65", Outside::zero);
    CHECK(d65.at(560.0) == 100.0);
    CHECK(d65.wavelengths_nm().back() == 780.0);
    CHECK(d65.at(785.0) == 0.0);
}

TEST_CASE("All errors of a table are reported with their places", "[unit]") {
    const auto found = complaints(
        "wavelength_nm,r,g\n"
        "400,0.5,1\n"
        "500,abc,1\n"
        "500,0.5,1\n"
        "600,0.5\n"
        "700,-0.1,1\n"
        "800, nan,1\n"
        "x,0.5,1\n"
        "-5,0.5,1\n"
        "900,\"0,5\",1\n",
        "r");
    REQUIRE(found.size() == 9);
    CHECK_THAT(found[0], Contains("3:5: 'abc' is not a finite number"));
    CHECK_THAT(found[1], Contains("4:1: wavelengths must increase"));
    CHECK_THAT(found[2], Contains("5:1: 2 cells; expected 3"));
    CHECK_THAT(found[3], Contains("6:5: -0.1 is negative"));
    CHECK_THAT(found[4], Contains("7:6: 'nan' is not a finite number"));
    CHECK_THAT(found[5], Contains("8:1: 'x' is not a finite number"));
    CHECK_THAT(found[6], Contains("9:1: a wavelength must be positive"));
    CHECK_THAT(found[7], Contains("9:1: wavelengths must increase"));
    CHECK_THAT(found[8], Contains("10:1: 4 cells; expected 3"));
}

TEST_CASE("Headers that do not say what is what are refused", "[unit]") {
    const auto only = [](std::string_view text, std::string_view column) {
        const auto found = complaints(text, column);
        REQUIRE(found.size() == 1);
        return found[0];
    };
    CHECK_THAT(only("wavelength,r\n400,1\n500,1\n", "r"),
               Contains("1:1: 'wavelength' names no unit of wavelength") &&
                   Contains("wavelength_nm or wavelength_um"));
    CHECK_THAT(only("400,0.5\n500,0.5\n", "0.5"), Contains("1:1: '400' names no unit"));
    CHECK_THAT(only("nm,wall,floor\n400,1,1\n500,1,1\n", "flor"),
               Contains("there is no column 'flor'; expected one of: wall, floor; did you mean "
                        "'floor'?"));
    CHECK_THAT(only("nm,wall,floor\n400,1,1\n500,1,1\n", ""), Contains("no column was chosen"));
    CHECK_THAT(only("nm,wall,wall\n400,1,1\n500,1,1\n", "wall"), Contains("two columns 'wall'"));
    CHECK_THAT(only("wavelength_nm\n400\n", ""), Contains("there is no column of values"));
    CHECK_THAT(only("nm,r\n400,1\n", "r"), Contains("1:4: 'r' has 1 values; expected at least 2"));
    CHECK_THAT(only("# nothing\n", ""), Contains("is empty"));
    CHECK_THROWS_AS(read_spectrum_csv("/no/such/file.csv", "r", Outside::hold), InputError);
}

TEST_CASE("Text that is no table ends in an error, not in a crash", "[fuzz]") {
    const std::string seed = "wavelength_nm,r\n400,0.5\n500,0.7\n600,0.9\n";
    std::uint32_t state = 1;
    for (int round = 0; round < 2000; ++round) {
        std::string text = seed;
        for (int edit = 0; edit < 4; ++edit) {
            state = state * 1664525u + 1013904223u;
            text[(state >> 8) % text.size()] = static_cast<char>(state >> 24);
        }
        try {
            const Spectrum spectrum = spectrum_from_text(text, "r");
            CHECK(spectrum.values().size() >= 2);
        } catch (const InputError& error) {
            CHECK_FALSE(error.diagnostics().empty());
        }
    }
}
