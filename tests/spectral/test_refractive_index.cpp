#include "io/refractive_index.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "core/diagnostics.h"
#include "tests/spectral/text_file.h"

using namespace lucerna;
using Catch::Contains;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;
using io::read_refractive_index;
using io::RefractiveIndexData;

namespace {

// Fraunhofer lines [nm] (ISO 7944)
constexpr double d_line = 587.5618;
constexpr double f_line = 486.1327;
constexpr double c_line = 656.2725;

RefractiveIndexData shipped(const std::string& name) {
    return read_refractive_index(LUCERNA_DATA_DIR "/refractive/" + name);
}

RefractiveIndexData from_text(const std::string& text) {
    return read_refractive_index(TextFile(text).path());
}

// The complaints about a text, each as "line:column: message".
std::vector<std::string> complaints(const std::string& text) {
    try {
        from_text(text);
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

TEST_CASE("Shipped materials have their published index", "[unit]") {
    struct Published {
        const char* file;
        double wavelength_nm;
        double n;
        double tolerance;
    };
    const Published row = GENERATE(
        Published{"schott__N-BK7.yml", d_line, 1.51680, 5e-6},     // Schott data sheet
        Published{"schott__SF11.yml", d_line, 1.78472, 5e-6},      // Schott data sheet
        Published{"SiO2__Malitson.yml", d_line, 1.45846, 5e-6},    // Malitson 1965, table 1
        Published{"H2O__Daimon-20.0C.yml", 589.3, 1.33336, 5e-5},  // IAPWS R9-97, in vacuum
        Published{"H2O__Hale.yml", 600.0, 1.332, 1e-12},           // a row of the table
        Published{"poly_methyl_methacrylate___Beadie.yml", d_line, 1.4918, 1e-3},
        Published{"poly_methyl_methacrylate___Sultanova.yml", d_line, 1.491, 6e-4},
        Published{"poly_methyl_methacrylate___Szczurowski.yml", d_line, 1.4918, 2e-3},
        Published{"polycarbonate__Sultanova.yml", d_line, 1.585, 6e-4},
        Published{"polystyrene__Sultanova.yml", d_line, 1.592, 1e-3},
        Published{"ZeonexE48R__Sultanova.yml", d_line, 1.531, 6e-4},
        Published{"polydimethylsiloxane__Schneider-RTV615.yml", d_line, 1.430, 1e-3});
    INFO(row.file);
    const RefractiveIndexData data = shipped(row.file);
    CHECK_THAT(data.n.at(row.wavelength_nm), WithinAbs(row.n, row.tolerance));
    CHECK(data.dispersive);
    CHECK_FALSE(data.reference.empty());
    CHECK_THAT(data.reference, !Contains("<"));
}

TEST_CASE("Abbe numbers of the glasses are those of their data sheets", "[unit]") {
    for (const auto& [file, abbe_number] :
         {std::pair{"schott__N-BK7.yml", 64.17}, {"schott__SF11.yml", 25.76}}) {
        const auto n = shipped(file).n;
        CHECK_THAT((n.at(d_line) - 1.0) / (n.at(f_line) - n.at(c_line)),
                   WithinAbs(abbe_number, 0.006));
    }
}

TEST_CASE("Metals come with n and k of their table", "[unit]") {
    const RefractiveIndexData silver = shipped("Ag__Johnson.yml");
    REQUIRE(silver.k);
    CHECK_THAT(silver.n.at(659.5), WithinRel(0.05, 1e-12));
    CHECK_THAT(silver.k->at(659.5), WithinRel(4.483, 1e-12));
    CHECK_THAT(silver.k->at(0.5 * (616.8 + 659.5)), WithinRel(0.5 * (4.152 + 4.483), 1e-12));
    CHECK_THAT(silver.min_nm, WithinRel(187.9, 1e-12));
    CHECK_THAT(silver.max_nm, WithinRel(1937.0, 1e-12));
    CHECK(silver.warnings.empty());
    CHECK_THAT(shipped("Au__Johnson.yml").k->at(821.1), WithinRel(5.083, 1e-12));
    CHECK_THAT(shipped("Cu__Johnson.yml").n.at(821.1), WithinRel(0.26, 1e-12));
    CHECK(shipped("Al__McPeak.yml").k->at(550.0) > 5.8);
}

TEST_CASE("A formula with a table of k gives both", "[unit]") {
    const RefractiveIndexData glass = shipped("schott__N-BK7.yml");
    REQUIRE(glass.k);
    CHECK_THAT(glass.k->at(546.0), WithinRel(6.9658e-9, 1e-12));
    CHECK(glass.warnings.empty());
    CHECK_THAT(glass.reference, Contains("SCHOTT Zemax catalog 2017-01-20b"));
}

TEST_CASE("Files with the rarer formulas are read", "[unit]") {
    struct Published {
        const char* file;
        double wavelength_nm;
        double n;
        double tolerance;
    };
    // The indices of solids and gases in the CRC Handbook, section 10, but for the last digit.
    const Published row =
        GENERATE(Published{"formula_4_TiO2_Devore.yml", 589.3, 2.613, 1.5e-3},
                 Published{"formula_5_SiC_Shaffer.yml", 589.3, 2.652, 1.5e-3},
                 Published{"formula_6_NH3_Cuthbertson.yml", 589.3, 1.000376, 1e-6},
                 Published{"formula_7_made_up.yml", 500.0, 1.515028051, 3e-7},
                 Published{"formula_8_AgBr_Schroter.yml", 589.3, 2.253, 5e-3},
                 Published{"formula_9_urea_Rosker.yml", 587.6, 1.606460948, 3e-7});
    INFO(row.file);
    const RefractiveIndexData data =
        read_refractive_index(std::string(LUCERNA_TEST_DATA "/spectral/") + row.file);
    CHECK_THAT(data.n.at(row.wavelength_nm), WithinAbs(row.n, row.tolerance));
    CHECK_FALSE(data.k);
}

TEST_CASE("Values held outside their range are reported", "[unit]") {
    const RefractiveIndexData pmma = shipped("poly_methyl_methacrylate___Sultanova.yml");
    CHECK_THAT(pmma.min_nm, WithinRel(436.8, 1e-12));
    CHECK_THAT(pmma.max_nm, WithinRel(1052.0, 1e-12));
    CHECK(pmma.n.at(360.0) == pmma.n.at(436.8));
    REQUIRE(pmma.warnings.size() == 1);
    CHECK_THAT(pmma.warnings[0], Contains("n is given from 436.8 to 1052 nm"));
    CHECK_THAT(pmma.warnings[0], Contains("from 360 to 436.8 nm"));
    CHECK_THAT(pmma.warnings[0], Contains("is held"));
    // below and above
    CHECK(read_refractive_index(LUCERNA_TEST_DATA "/spectral/formula_5_SiC_Shaffer.yml")
              .warnings.size() == 2);
}

TEST_CASE("An index that does not vary is not dispersive", "[unit]") {
    const RefractiveIndexData flat = from_text(
        "DATA:\n"
        "  - type: tabulated n\n"
        "    data: |\n"
        "        0.3 1.49\n"
        "        0.9 1.49\n");
    CHECK_FALSE(flat.dispersive);
    CHECK(flat.n.at(500.0) == 1.49);
    CHECK(from_text("DATA:\n  - {type: tabulated n, data: 0.5893 1.49}\n").n.at(700.0) == 1.49);
}

TEST_CASE("What is not the index is named or left out", "[unit]") {
    const RefractiveIndexData data = from_text(
        "DATA:\n"
        "  - type: formula 5\n"
        "    range: 0.3 0.9\n"  // as older releases of the database write it
        "    coefficients: 1.5\n"
        "  - type: tabulated n2\n"
        "    data: |\n"
        "        0.5 1e-20\n"
        "  - type: tabulated k\n"
        "    data: |\n"
        "        2.0 1e-3\n"
        "        3.0 1e-3\n");
    CHECK(data.n.at(555.0) == 1.5);
    CHECK_FALSE(data.k);
    REQUIRE(data.warnings.size() == 2);
    CHECK_THAT(data.warnings[0], Contains("nonlinear"));
    CHECK_THAT(data.warnings[1], Contains("k is given from 2000 to 3000 nm only"));
}

TEST_CASE("All errors of a file are reported with their places", "[unit]") {
    const auto found = complaints(
        "DATA:\n"
        "  - type: tabulated nk\n"
        "    data: |\n"
        "        0.3 1.5 0\n"
        "        0.4 1.5\n"
        "        0.5 x1.5 -1\n"
        "        0.45 1.5 nan\n"
        "        0.9 1.5 0\n"
        "  - type: formula 2\n"
        "    wavelength_range: 0.9 0.3\n"
        "    coefficients: 0 1.2\n");
    REQUIRE(found.size() == 8);
    CHECK_THAT(found[2], Contains("5:9: 2 numbers in a row; expected 3"));
    CHECK_THAT(found[0], Contains("6:13: 'x1.5'"));
    CHECK_THAT(found[1], Contains("7:18: 'nan'"));
    CHECK_THAT(found[3], Contains("6:18: k must not be negative"));
    CHECK_THAT(found[4], Contains("7:9: wavelengths must increase"));
    CHECK_THAT(found[5], Contains("9:11: ") && Contains("second time"));
    CHECK_THAT(found[6], Contains("9:11: ") && Contains("formula 2 has 2 coefficients"));
    CHECK_THAT(found[7], Contains("10:23: ") && Contains("two increasing wavelengths"));
}

TEST_CASE("A file without a usable index is refused", "[unit]") {
    const auto only = [](const std::string& text) {
        const auto found = complaints(text);
        REQUIRE(found.size() == 1);
        return found[0];
    };
    CHECK_THAT(only("REFERENCES: nobody\n"), Contains("the key 'DATA' is missing"));
    CHECK_THAT(only("DATA:\n  - type: tabulated k\n    data: |\n      0.4 1\n      0.7 1\n"),
               Contains("holds no index of refraction"));
    CHECK_THAT(only("DATA:\n  - type: formula 12\n    wavelength_range: 0.3 1\n"
                    "    coefficients: 1\n"),
               Contains("2:11") && Contains("there is no formula 12; expected 1 to 9"));
    CHECK_THAT(complaints("DATA:\n  - type: Sellmeier\n").front(),
               Contains("2:11") && Contains("'Sellmeier' is not a type that is known"));
    CHECK_THAT(
        only("DATA:\n  - type: formula 5\n    wavelength_range: 2 5\n    coefficients: 1.5\n"),
        Contains("3:23") && Contains("2000 to 5000 nm and nothing of 360 to 830 nm"));
    CHECK_THAT(only("DATA:\n  - type: formula 1\n    wavelength_range: 0.4 0.7\n"
                    "    coefficients: 0 1 0.5\n"),
               Contains("4:19") && Contains("no positive index at"));
    CHECK_THAT(only("DATA:\n  - type: formula 5\n    wavelength_range: 0.4 0.7\n"),
               Contains("the key 'coefficients' is missing"));
    CHECK_THROWS_AS(read_refractive_index("/no/such/file.yml"), InputError);
    CHECK_THROWS_AS(from_text("DATA: [\n"), InputError);
    CHECK_THROWS_AS(from_text(""), InputError);
}

TEST_CASE("A spoilt file ends in an error, not in a crash", "[fuzz]") {
    const std::string seed =
        "REFERENCES: |\n    somebody\n"
        "DATA:\n  - type: formula 2\n    wavelength_range: 0.3 2.5\n"
        "    coefficients: 0 1.03961212 0.00600069867\n"
        "  - type: tabulated k\n    data: |\n        0.3 1E-6\n        0.9 2E-6\n";
    std::uint32_t state = 7;
    for (int round = 0; round < 3000; ++round) {
        std::string text = seed;
        for (int edit = 0; edit < 3; ++edit) {
            state = state * 1664525u + 1013904223u;
            // mostly by other letters of the file, so that much of it stays YAML
            text[(state >> 8) % text.size()] =
                edit == 0 ? static_cast<char>(state >> 24) : seed[(state >> 4) % seed.size()];
        }
        try {
            const RefractiveIndexData data = from_text(text);
            CHECK(data.n.min() > 0.0);
            if (data.k) CHECK(data.k->min() >= 0.0);
        } catch (const InputError& error) {
            CHECK_FALSE(error.diagnostics().empty());
        }
    }
}
