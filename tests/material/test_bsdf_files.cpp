// Readers of measured scattering data: what is read, and what is complained about, where.
#include <fmt/format.h>
#include <catch2/catch.hpp>

#include "core/diagnostics.h"
#include "core/random.h"
#include "io/bsdf_table.h"
#include "io/bsdf_xml.h"
#include "surface_fixture.h"

using namespace lucerna;
using namespace lucerna::io;
using namespace lucerna::optics;
using namespace lucerna::test;
using Catch::Contains;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

TextFile text_file(const std::string& text) {
    TextFile file{"test", {}};
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        file.lines.push_back(text.substr(begin, end - begin));
        begin = end + 1;
    }
    return file;
}

/// All complaints, one per line; empty if the file is accepted.
template <typename Read>
std::string complaints(Read read) {
    try {
        read();
        return "";
    } catch (const InputError& error) {
        std::string all;
        for (const Diagnostic& diagnostic : error.diagnostics()) all += diagnostic.text() + "\n";
        return all;
    }
}
std::string xml_complaints(const std::string& text) {
    const TextFile file = text_file(text);
    return complaints([&] { read_bsdf_xml(file); });
}
std::string table_complaints(const std::string& text) {
    const TextFile file = text_file(text);
    return complaints([&] { read_bsdf_table(file); });
}

const std::string shipped = std::string(LUCERNA_DATA_DIR) + "/bsdf/2011-SA1.XML";
const std::string test_data = std::string(LUCERNA_TEST_DATA) + "/material/";

const KlemsBsdf& klems(const MeasuredBsdf& measured) {
    return std::get<KlemsBsdf>(measured.data);
}

/// A two-patch basis: within and beyond 45 deg.
std::string small_xml(const std::string& structure, const std::string& blocks) {
    return fmt::format(R"(<?xml version="1.0"?>
<WindowElement><Optical><Layer>
<DataDefinition><IncidentDataStructure>{}</IncidentDataStructure>
<AngleBasis><AngleBasisName>Two</AngleBasisName>
<AngleBasisBlock><nPhis>1</nPhis><ThetaBounds><LowerTheta>0</LowerTheta><UpperTheta>45</UpperTheta></ThetaBounds></AngleBasisBlock>
<AngleBasisBlock><nPhis>1</nPhis><ThetaBounds><LowerTheta>45</LowerTheta><UpperTheta>90</UpperTheta></ThetaBounds></AngleBasisBlock>
</AngleBasis></DataDefinition>
<WavelengthData><Wavelength unit="Integral">Visible</Wavelength>
{}
</WavelengthData></Layer></Optical></WindowElement>
)",
                       structure, blocks);
}
std::string block(const std::string& part, const std::string& values) {
    return fmt::format(
        "<WavelengthDataBlock><WavelengthDataDirection>{}</WavelengthDataDirection>"
        "<ColumnAngleBasis>Two</ColumnAngleBasis><RowAngleBasis>Two</RowAngleBasis>\n"
        "<ScatteringData>\n{}</ScatteringData></WavelengthDataBlock>",
        part, values);
}
/// Parts that are not of interest, black.
std::string other_blocks() {
    return block("Transmission Back", "0 0 0 0") + block("Reflection Front", "0 0 0 0") +
           block("Reflection Back", "0 0 0 0");
}

}  // namespace

TEST_CASE("The shipped fabric is read with the transmittance that its numbers add up to",
          "[unit]") {
    const auto measured = read_bsdf_file(shipped);
    CHECK(measured->warnings.empty());
    CHECK_FALSE(is_isotropic(*measured));
    CHECK(transmits(*measured));
    // Independent sums over the columns of the file (awk), normal incidence: transmission front
    // 0.09587, back 0.09432, reflection front 0.48246, back 0.56000.
    CHECK_THAT(klems(*measured).directional_hemispherical(Vec3(0, 0, 1)),
               WithinAbs(0.09587 + 0.48246, 2e-5));
    CHECK_THAT(klems(*measured).directional_hemispherical(Vec3(0, 0, -1)),
               WithinAbs(0.09432 + 0.56000, 2e-5));
    // The first two numbers of the block "Transmission Front".
    CHECK_THAT(klems(*measured).bsdf_per_sr(Vec3(0, 0, 1), Vec3(0, 0, -1)),
               WithinAbs(2.063833, 1e-6));
    CHECK_THAT(klems(*measured).bsdf_per_sr(direction(10, 180), Vec3(0, 0, -1)),
               WithinAbs(0.014938, 1e-6));
}

TEST_CASE("Missing parts are told: transmission by reciprocity, the rest black", "[unit]") {
    const auto measured = read_bsdf_file(test_data + "blinds30.xml");
    REQUIRE(measured->warnings.size() == 2);
    CHECK_THAT(measured->warnings[0],
               Contains("Transmission Front") &&
                   Contains("follows from Transmission Back by reciprocity"));
    CHECK_THAT(measured->warnings[1], Contains("Reflection Front") && Contains("black"));
    const Vec3 in = direction(40.0, 80.0), out = direction(150.0, 200.0);
    CHECK(klems(*measured).bsdf_per_sr(in, out) == klems(*measured).bsdf_per_sr(out, in));
    CHECK(klems(*measured).bsdf_per_sr(in, out) > 0.0);
}

TEST_CASE("A simulated blind is reciprocal under the convention of azimuth", "[unit]") {
    // Reversed light arrives from where it left: sector of the incident patch is that of the
    // outgoing one turned by 180 deg, since one counts propagation and the other direction. Sums
    // over all pairs, because single values have the noise of the simulation (5 %).
    const auto measured = read_bsdf_file(test_data + "blinds30.xml");
    const KlemsMatrix& reflection = *klems(*measured).parts().reflection[1];
    const KlemsMatrix reversed = *reflection.reversed();
    double sum = 0.0, difference = 0.0, without_turn = 0.0;
    for (int i = 0; i < 145; ++i) {
        for (int o = 0; o < 145; ++o) {
            const double weight = reflection.incident().projected_solid_angle_sr(i) *
                                  reflection.outgoing().projected_solid_angle_sr(o);
            const double f = reflection.bsdf_per_sr(i, o);
            sum += weight * f;
            difference += weight * std::abs(f - reversed.bsdf_per_sr(i, o));
            without_turn += weight * std::abs(f - reflection.bsdf_per_sr(o, i));
        }
    }
    CHECK(difference < 0.1 * sum);
    CHECK(without_turn > sum);  // twin
}

TEST_CASE("Incident directions are columns or rows as the file says", "[unit]") {
    const auto f = [](const std::string& structure) {
        const TextFile file = text_file(small_xml(
            structure, block("Transmission Front", "0.1, 0.2,\n0.3, 0.05") + other_blocks()));
        // Light at normal incidence that leaves at 60 deg.
        return klems(read_bsdf_xml(file)).bsdf_per_sr(Vec3(0, 0, 1), direction(120.0, 0.0));
    };
    CHECK_THAT(f("Columns"), WithinAbs(0.3, 1e-6));
    CHECK_THAT(f("Rows"), WithinAbs(0.2, 1e-6));
}

TEST_CASE("All that is wrong with an XML file is told with its place", "[golden]") {
    const std::string text = small_xml(
        "Columns", block("Transmission Front", "0.1 -0.2\n0.3 nonsense") +
                       block("Reflection Front", "0.1 0.1 0.1") + block("Sideways", "0 0 0 0") +
                       block("Reflection Front", "0 0 0 0"));
    const std::string found = xml_complaints(text);
    CHECK_THAT(found, Contains("test:11:5: \"-0.2\" is no BSDF value; expected a number >= 0"));
    CHECK_THAT(found, Contains("test:12:5: \"nonsense\" is no BSDF value"));
    CHECK_THAT(found, Contains("test:13:") &&
                          Contains("ScatteringData has 3 values; expected 2 rows x 2 columns = 4"));
    CHECK_THAT(found, Contains("\"Sideways\"; expected Transmission Front"));
    CHECK_THAT(found, Contains("is a second matrix for Reflection Front"));
}

TEST_CASE("XML files that cannot be used say why", "[golden]") {
    CHECK_THAT(complaints([] { read_bsdf_file(test_data + "tensor_tree.xml"); }),
               Contains("tensor trees are not supported; expected matrices on a Klems basis"));
    CHECK_THAT(xml_complaints("<WindowElement><Optical>"), Contains("is not well-formed XML"));
    CHECK_THAT(xml_complaints("<Room/>"),
               Contains("begins with <Room>; expected the LBNL BSDF format"));
    CHECK_THAT(xml_complaints(small_xml("Columns", "")),
               Contains("has no matrix for the wavelength \"Visible\""));
    CHECK_THAT(
        xml_complaints(small_xml("Diagonals", other_blocks())),
        Contains("IncidentDataStructure is \"Diagonals\"; expected \"Columns\" or \"Rows\""));
    std::string unknown = small_xml("Columns", other_blocks());
    unknown.replace(unknown.find("<RowAngleBasis>Two"), 18, "<RowAngleBasis>Six");
    CHECK_THAT(xml_complaints(unknown),
               Contains("RowAngleBasis is \"Six\"; expected one of: LBNL/Klems Full"));
    CHECK_THAT(complaints([] { read_bsdf_file("/no/such/file.xml"); }),
               Contains("/no/such/file.xml"));
}

TEST_CASE("A matrix that scatters more light than arrives is refused", "[unit]") {
    // Both patches have the projected solid angle pi/2: light at normal incidence is scattered to
    // (f + f) pi / 2.
    const auto with = [](double f) {
        return text_file(
            small_xml("Columns",
                      block("Transmission Front", fmt::format("{0} 0 {0} 0", f)) + other_blocks()));
    };
    const TextFile too_much = with(1.02 / pi), a_little = with(1.005 / pi),
                   right = with(0.999 / pi);
    CHECK_THAT(complaints([&] { read_bsdf_xml(too_much); }),
               Contains("light from the front is scattered to 1.0200 of itself") &&
                   Contains("expected at most 1.01"));
    CHECK_THAT(read_bsdf_xml(a_little).warnings.at(0), Contains("1.0050"));
    CHECK(read_bsdf_xml(right).warnings.empty());
}

namespace {

const std::string table_head =
    "# lucerna bsdf table 1\n# a comment\nblack: reflection back, transmission front, transmission "
    "back\n";

}  // namespace

TEST_CASE("A table is read, in any order of its rows", "[unit]") {
    const TextFile file =
        text_file(table_head +
                  "part, theta_in_deg, theta_out_deg, wavelength_nm, bsdf_per_sr\n"
                  "reflection front, 0, 90, 780, 0.1\n"
                  "reflection front, 0,  0, 380, 0.2\n\n"
                  "reflection front, 0,  0, 780, 0.3\n"
                  "reflection front, 0, 90, 380, 0.1\n"
                  "reflection front, 90, 90, 380, 0.1\n"
                  "reflection front, 90, 90, 780, 0.1\n"
                  "reflection front, 90, 0, 380, 0.25\n"
                  "reflection front, 90, 0, 780, 0.2\n");
    const MeasuredBsdf measured = read_bsdf_table(file);
    CHECK(measured.warnings.empty());
    CHECK(is_isotropic(measured));
    CHECK_FALSE(transmits(measured));
    const auto& table = std::get<TabulatedBsdf>(measured.data);
    const Surface surface;
    const Lanes f = table.bsdf_per_sr(Vec3(0, 0, 1), Vec3(0, 0, 1), surface.wavelengths);
    CHECK_THAT(static_cast<double>(f[0]), WithinRel(0.205, 1e-5));  // at 400 nm
    CHECK((table.bsdf_per_sr(Vec3(0, 0, 1), Vec3(0, 0, -1), surface.wavelengths) == 0.0f).all());
}

TEST_CASE("What a table does not cover is a warning", "[unit]") {
    const TextFile file =
        text_file(table_head +
                  "part, theta_in_deg, theta_out_deg, wavelength_nm, bsdf_per_sr\n"
                  "reflection front, 10, 10, 500, 0.2\n"
                  "reflection front, 10, 80, 500, 0.2\n"
                  "reflection front, 10, 10, 600, 0.2\n"
                  "reflection front, 10, 80, 600, 0.2\n");
    const MeasuredBsdf measured = read_bsdf_table(file);
    REQUIRE(measured.warnings.size() == 3);
    CHECK_THAT(measured.warnings[0], Contains("theta_in_deg reaches from 10 to 10"));
    CHECK_THAT(measured.warnings[1], Contains("theta_out_deg reaches from 10 to 80"));
    CHECK_THAT(measured.warnings[2], Contains("wavelengths reach from 500 to 600 nm"));
}

TEST_CASE("All that is wrong with a table is told with its place", "[golden]") {
    const std::string columns = "part, theta_in_deg, theta_out_deg, delta_phi_deg, bsdf_per_sr\n";
    CHECK_THAT(table_complaints("angles\n"), Contains("test:1:1: is no BSDF file"));
    CHECK_THAT(
        table_complaints(table_head + columns + "reflection front, 0, 95, 0, x\nup, 0, 0, 0, 1\n"),
        Contains("test:5:22: theta_out_deg is \"95\"; expected a number from 0 to 90") &&
            Contains("test:5:29: bsdf_per_sr is \"x\"") && Contains("test:6") &&
            Contains("\"up\" is no part of a BSDF; expected reflection front"));
    CHECK_THAT(table_complaints(table_head + "part, theta_in_deg, colour, bsdf_per_sr\n"),
               Contains("test:4") && Contains("the column \"colour\" is unknown") &&
                   Contains("the column theta_out_deg is missing"));
    CHECK_THAT(table_complaints(table_head + columns + "reflection front, 0, 0, 0\n"),
               Contains("test:5") && Contains("has 4 columns; expected 5"));
    CHECK_THAT(
        table_complaints("# lucerna bsdf table 1\n" + columns + "reflection front, 0, 0, 0, 0.1\n"),
        Contains("transmission back is missing; expected rows for it, or the line \"black: "
                 "transmission back\""));
    CHECK_THAT(table_complaints(table_head + columns + "reflection front, 0, 0, 0, .1\n" +
                                "reflection front, 0, 0, 0, .1\n"),
               Contains("test:6") && Contains("repeats the angles and wavelength of line 5"));
    CHECK_THAT(
        table_complaints(table_head + columns + "reflection front, 0, 0, 0, .1\n" +
                         "reflection front, 0, 0, 180, .1\nreflection front, 10, 0, 180, .1\n"),
        Contains("is no full grid"));
    CHECK_THAT(table_complaints(table_head + columns + "reflection front, 0, 0, 0, .1\n" +
                                "reflection front, 0, 0, 90, .1\n"),
               Contains("delta_phi_deg reaches from 0 to 90; expected from 0 to 180"));
    CHECK_THAT(table_complaints(table_head + columns + "reflection front, 0, 0, 0, 0.33\n"),
               Contains("is scattered to 1.0367 of itself"));
}

TEST_CASE("Damaged files are refused or read, never more", "[fuzz]") {
    const TextFile xml = text_file(
        small_xml("Columns", block("Transmission Front", "0.1 0.2\n0.3 0.05") + other_blocks()));
    const TextFile table =
        text_file(table_head +
                  "part, theta_in_deg, theta_out_deg, wavelength_nm, bsdf_per_sr\n"
                  "reflection front, 0, 0, 400, 0.2\n"
                  "reflection front, 0, 90, 400, 0.2\n");
    RandomStream random(17, 0, RandomPurpose::test, 0);
    const auto below = [&](std::size_t n) {
        return static_cast<std::size_t>(random.uniform() * static_cast<double>(n));
    };
    constexpr std::string_view bytes = "<>/\",.-0123456789eE \tx&;#:";
    for (int i = 0; i < 4000; ++i) {
        TextFile damaged = i % 2 ? xml : table;
        for (std::size_t changes = 1 + below(3); changes-- > 0;) {
            std::string& line = damaged.lines[below(damaged.lines.size())];
            const std::size_t place = below(line.size() + 1);
            switch (below(4)) {
                case 0:
                    line.insert(place, 1, bytes[below(bytes.size())]);
                    break;
                case 1:
                    line.erase(place, 1 + below(5));
                    break;
                case 2:
                    if (place < line.size()) line[place] = bytes[below(bytes.size())];
                    break;
                default:
                    line.clear();
            }
        }
        try {
            if (i % 2) {
                read_bsdf_xml(damaged);
            } else {
                read_bsdf_table(damaged);
            }
        } catch (const InputError& error) {
            REQUIRE_FALSE(error.diagnostics().empty());
            REQUIRE(error.diagnostics().front().where.file == "test");
        }
    }
}
