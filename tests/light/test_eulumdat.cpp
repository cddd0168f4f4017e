#include "light_checks.h"
#include "photometry_files.h"

using namespace lucerna;
using namespace lucerna::test;
using Catch::Matchers::Contains;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;
using Kind = Opening::Kind;

namespace {

// An EULUMDAT file with gamma = 0, 90, 180 whose stored plane i has the values 100, 10 + i, 0.
struct Sketch {
    int symmetry = 0;
    int planes = 4;
    int stored = 4;
    std::string step = "90";
    std::string sizes = "1000\n200\n50\n800\n100\n0\n0\n0\n0\n";  // lines 13 to 21
    std::string ratios = "60\n100\n1\n0\n";                       // lines 22 to 25
    std::string lamps = "1\n1\nLED\n1000\n4000\n80\n10\n";        // from line 26
    std::string values = "";                                      // instead of the stored planes

    std::string text() const {
        std::string result =
            fmt::format("Maker\n1\n{}\n{}\n{}\n3\n90\nreport\nlamp\nnumber\nfile\ndate\n", symmetry,
                        planes, step);
        result += sizes + ratios + lamps + "0\n0\n0\n0\n0\n0\n0\n0\n0\n0\n";
        for (int i = 0; i < planes; ++i) result += fmt::format("{}\n", 360 * i / planes);
        result += "0\n90\n180\n";
        if (!values.empty()) return result + values;
        for (int i = 0; i < stored; ++i) result += fmt::format("100\n{}\n0\n", 10 + i);
        return result;
    }
    PhotometricFile read(int lamp_set = 1) const { return read_text("a.ldt", text(), lamp_set); }
    std::string complaint() const { return complaints("a.ldt", text()); }
};

}  // namespace

TEST_CASE("An EULUMDAT file is read as it stands", "[light][eulumdat]") {
    const PhotometricFile file = Sketch{}.read();
    CHECK(file.format == "EULUMDAT");
    CHECK(file.manufacturer == "Maker");
    CHECK(file.luminaire == "lamp");
    CHECK(file.catalogue_number == "number");
    CHECK(file.report_number == "report");
    CHECK(file.date == "date");
    CHECK(file.symmetry == "none");
    CHECK(file.stated_flux_lm == 1000.0);
    CHECK(file.input_power_w == 10.0);
    CHECK(file.stated_downward_fraction == 0.6);
    // Length along C90 (y), width along C0 (x).
    CHECK(file.opening.kind == Kind::rectangle);
    CHECK((file.opening.size_m - Vec3(0.1, 0.8, 0.0)).norm() < 1e-15);
    for (int i = 0; i < 4; ++i) {
        CHECK_THAT(intensity_cd(file, 90 * i, 90), WithinRel(10.0 + i, 1e-12));
    }
    CHECK_THAT(intensity_cd(file, 315, 90), WithinRel(11.5, 1e-12));
}

TEST_CASE("All symmetries unfold to the same distribution", "[light][eulumdat]") {
    const auto at = [](const PhotometricFile& file, double c) { return intensity_cd(file, c, 90); };
    const PhotometricFile rotational =
        Sketch{.symmetry = 1, .planes = 24, .stored = 1, .step = "15"}.read();
    CHECK_THAT(at(rotational, 217), WithinRel(10.0, 1e-12));
    CHECK(rotational.stored_planes == 1);

    const PhotometricFile c0 = Sketch{.symmetry = 2, .planes = 8, .stored = 5, .step = "45"}.read();
    for (const double c : {0.0, 45.0, 90.0, 135.0, 180.0}) {
        CHECK_THAT(at(c0, c), WithinRel(10.0 + c / 45.0, 1e-12));
        CHECK_THAT(at(c0, 360.0 - c), WithinRel(10.0 + c / 45.0, 1e-12));
    }
    // Stored from C270 over C0 to C90 (Mc1 = 3 Mc / 4 + 1); Relux agrees, see its test.
    const PhotometricFile c90 =
        Sketch{.symmetry = 3, .planes = 8, .stored = 5, .step = "45"}.read();
    for (const double c : {-90.0, -45.0, 0.0, 45.0, 90.0}) {
        CHECK_THAT(at(c90, c), WithinRel(12.0 + c / 45.0, 1e-12));
        CHECK_THAT(at(c90, 180.0 - c), WithinRel(12.0 + c / 45.0, 1e-12));
    }
    const PhotometricFile both =
        Sketch{.symmetry = 4, .planes = 8, .stored = 3, .step = "45"}.read();
    for (const double c : {0.0, 45.0, 90.0}) {
        for (const double image : {c, 180.0 - c, 180.0 + c, 360.0 - c}) {
            CHECK_THAT(at(both, image), WithinRel(10.0 + c / 45.0, 1e-12));
        }
    }
    // All planes stored although a symmetry is stated.
    const PhotometricFile all =
        Sketch{.symmetry = 4, .planes = 8, .stored = 8, .step = "45"}.read();
    CHECK(mentions(all.deviations, "line 3: symmetry 4 is stated, but all 8 planes are stored"));
    CHECK_THAT(at(all, 315), WithinRel(17.0, 1e-12));
    CHECK_THAT((Sketch{.symmetry = 4, .planes = 6, .stored = 2, .step = "60"}.complaint()),
               Contains("a.ldt:4:1: 6 C planes cannot have symmetry 4; expected a multiple of 4"));
}

TEST_CASE("Intensities are scaled by the lamp set and the conversion factor", "[light][eulumdat]") {
    const std::string two = "2\n1\nLED\n1000\n4000\n80\n10\n2\nLED\n2500\n4000\n80\n30\n";
    const Sketch alternatives{.lamps = two};
    CHECK_THAT(alternatives.read(1).intensity.max_intensity_cd(), WithinRel(100.0, 1e-12));
    const PhotometricFile second = alternatives.read(2);
    CHECK_THAT(second.intensity.max_intensity_cd(), WithinRel(250.0, 1e-12));
    CHECK(second.input_power_w == 30.0);
    CHECK(second.lamp_sets.size() == 2);
    CHECK(mentions(second.notes, "2 alternative lamp sets; set 2 applies, with 2500 lm"));
    CHECK_THROWS_WITH(alternatives.read(3),
                      Contains("lamp set 3 is asked for; the file has sets 1 to 2"));
    const Sketch converted{.ratios = "60\n100\n1.5\n0\n"};
    CHECK_THAT(converted.read().intensity.max_intensity_cd(), WithinRel(150.0, 1e-12));
    CHECK_THAT(
        (Sketch{.ratios = "60\n100\n0\n0\n"}.complaint()),
        Contains("a.ldt:24:1: the conversion factor for intensities is 0; expected above 0"));
    const PhotometricFile absolute = Sketch{.lamps = "1\n-3\nLED\n2000\n4000\n80\n10\n"}.read();
    CHECK(absolute.absolute);
    CHECK(absolute.stated_flux_lm == 2000.0);
    CHECK_FALSE(absolute.light_output_ratio);
    CHECK_THAT(absolute.intensity.max_intensity_cd(), WithinRel(200.0, 1e-12));
}

TEST_CASE("Luminous areas are read with their shape and heights", "[light][eulumdat]") {
    const auto opening = [](const std::string& area) {
        return Sketch{.sizes = "1000\n200\n50\n" + area}.read().opening;
    };
    CHECK(opening("0\n0\n0\n0\n0\n0\n").kind == Kind::point);
    const Opening disk = opening("300\n0\n0\n0\n0\n0\n");
    CHECK(disk.kind == Kind::ellipse);
    CHECK((disk.size_m - Vec3(0.3, 0.3, 0.0)).norm() < 1e-15);
    const Opening cylinder = opening("300\n0\n50\n50\n50\n50\n");
    CHECK(cylinder.kind == Kind::cylinder);
    CHECK((cylinder.size_m - Vec3(0.3, 0.3, 0.05)).norm() < 1e-15);
    const Opening box = opening("800\n100\n10\n20\n30\n40\n");
    CHECK(box.kind == Kind::box);
    CHECK((box.size_m - Vec3(0.1, 0.8, 0.04)).norm() < 1e-15);
    CHECK(box.side_heights_m == std::array<double, 4>{0.01, 0.02, 0.03, 0.04});
    const PhotometricFile uneven = read_photometric_file(
        data_file("viewer_rectangular_luminaire_round_luminous_opening_with_heights.ldt"));
    CHECK(mentions(uneven.deviations, "line 18: a round luminous area with different heights"));
    const PhotometricFile blank = Sketch{.sizes = "1000\n200\n50\n800\n100\n\n0\n0\n0\n"}.read();
    CHECK(mentions(blank.deviations, "line 18: the height of the luminous area at C0 is blank"));
    CHECK_THAT((Sketch{.sizes = "1\n1\n1\n-800\n100\n0\n0\n0\n0\n"}.complaint()),
               Contains("a.ldt:16:1: the length of the luminous area is -800 mm; expected 0 to"));
}

TEST_CASE("Stated ratios are compared with the integral", "[light][eulumdat]") {
    // 1000 cd/klm at 4 pi sr would be 1256 %: here about 100 -> 10 -> 0 cd/klm over the sphere.
    const PhotometricFile file = Sketch{}.read();
    CHECK(mentions(file.deviations, "line 23: states a light output ratio of 100 %, but the"));
    CHECK(mentions(file.deviations, "line 22: states a downward flux fraction of 60 %, but the"));
    const std::string honest = fmt::format("{}\n{}\n1\n0\n", 100.0 * file.downward_fraction,
                                           100.0 * *file.light_output_ratio);
    CHECK(Sketch{.ratios = honest}.read().deviations.empty());
    const std::string off = fmt::format("{}\n{}\n1\n0\n", 100.0 * file.downward_fraction,
                                        101.5 * *file.light_output_ratio);
    CHECK(Sketch{.ratios = off}.read().deviations.size() == 1);
    CHECK(mentions((Sketch{.ratios = "60\n100\n1\n15\n"}.read().notes),
                   "tilt of 15 deg, which is not applied"));
}

TEST_CASE("Deviations of real files are those that are there", "[light][eulumdat]") {
    for (const char* clean : {"sample_01.ldt", "sample_02.ldt", "sample_03.ldt", "sample_04.ldt",
                              "tulux_box.ldt", "trilux_asymmetric.ldt"}) {
        const PhotometricFile file = read_photometric_file(data_file(clean));
        INFO(clean);
        CHECK(file.deviations.empty());
        CHECK_THAT(*file.light_output_ratio, WithinRel(*file.stated_light_output_ratio, 0.01));
        CHECK_THAT(file.downward_fraction, WithinAbs(*file.stated_downward_fraction, 0.001));
    }
    const PhotometricFile odd = read_photometric_file(data_file("viewer_no_symmetry.ldt"));
    CHECK(odd.deviations.size() == 3);
    CHECK(mentions(odd.deviations, "line 5: states C angles every 90 deg, but 15 follows 0"));
    CHECK(mentions(odd.deviations, "intensities at gamma = 0 differ between the C planes"));
    CHECK(mentions(odd.deviations, "but the intensities integrate to 372.2 %"));
}

TEST_CASE("Decimal commas, line ends and encodings are read", "[light][eulumdat]") {
    const PhotometricFile comma = Sketch{.ratios = "60\n99,5\n1\n0\n"}.read();
    CHECK(comma.stated_light_output_ratio == 0.995);
    CHECK(mentions(comma.deviations, "line 23: a decimal comma"));
    std::string crlf;
    for (const char c : Sketch{}.text())
        crlf += c == '\n' ? std::string("\r\n") : std::string(1, c);
    CHECK(read_text("a.ldt", crlf).deviations == Sketch{}.read().deviations);
    CHECK(read_text("a.ldt", replaced(Sketch{}.text(), "Maker", "M\xE4ker")).manufacturer ==
          "M\xC3\xA4ker");
    CHECK(read_text("noname.txt", Sketch{}.text()).format == "EULUMDAT");
    CHECK_THAT(complaints("a.txt", "some\nwords\n"), Contains("is neither IES LM-63"));
}

TEST_CASE("Errors of an EULUMDAT file have a place and come together", "[light][eulumdat]") {
    const std::string text = Sketch{}.text();
    CHECK_THAT(complaints("a.ldt", text.substr(0, 60)),
               Contains("expected the 26 lines of the header"));
    CHECK_THAT(complaints("a.ldt", text.substr(0, text.size() - 2)),
               Contains("the file ends after 11 of 12 values of intensity"));
    const std::string header =
        complaints("a.ldt", replaced(replaced(text, "Maker\n1\n0\n4\n", "Maker\n1\n7\nfour\n"),
                                     "800\n100", "8oo\n100"));
    CHECK_THAT(
        header,
        Contains("a.ldt:3:1: the symmetry indicator is 7; expected a whole number from 0 to 4"));
    CHECK_THAT(
        header,
        Contains("a.ldt:4:1: \"four\" stands for the number of C planes; expected a number"));
    CHECK_THAT(header, Contains("a.ldt:16:1: \"8oo\" stands for the length of the luminous area"));
    CHECK_THAT((Sketch{.lamps = "1\n1\nLED\n0\n4000\n80\n10\n"}.complaint()),
               Contains("a.ldt:29:1: the luminous flux of the lamps is 0 lm; expected above 0"));
    CHECK_THAT((Sketch{.values = "100\n-10\n0\n 100\n zz\n0\n100\n1\n0\n100\n1\n0\n"}.complaint()),
               Contains("a.ldt:51:1: the intensity -10 is negative") &&
                   Contains("a.ldt:54:2: \"zz\" stands for an intensity of stored plane 2"));
    CHECK_THAT(complaints("a.ldt", replaced(text, "\n180\n270\n", "\n180\n170\n")),
               Contains("C angles must increase; 170 follows 180"));
    CHECK(mentions(read_text("a.ldt", text + "5\n").deviations,
                   "1 more words follow the last intensity"));
}
