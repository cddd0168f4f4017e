#include "light_checks.h"
#include "optics/light/goniometer.h"
#include "photometry_files.h"

using namespace lucerna;
using namespace lucerna::test;
using Catch::Matchers::Contains;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;
using Kind = Opening::Kind;
using Axis = Opening::Axis;

namespace {

// A small file of the 2002 edition; parts are replaced in the tests.
const std::string plain =
    "IESNA:LM-63-2002\n"
    "[TEST] 1\n[TESTLAB] here\n[ISSUEDATE] today\n[MANUFAC] Maker\n"
    "TILT=NONE\n"
    "2 500 1 3 3 1 2 0.3 1.2 0\n"
    "1 1 40\n"
    "0 45 90\n"
    "0 45 90\n"
    "100 80 10\n"
    "100 70 20\n"
    "100 60 30\n";

std::string with_opening(const std::string& header, const std::string& sizes) {
    return replaced(replaced(plain, "IESNA:LM-63-2002", header), "0.3 1.2 0", sizes);
}

Opening opening_of(const std::string& header, const std::string& sizes) {
    const PhotometricFile file = read_text("a.ies", with_opening(header, sizes));
    CHECK_FALSE(mentions(file.deviations, "dimensions"));
    return file.opening;
}

void check_opening(const Opening& opening, Kind kind, const Vec3& size_m, Axis axis = Axis::z) {
    CHECK(opening.kind == kind);
    CHECK((opening.size_m - size_m).norm() < 1e-12);
    CHECK(opening.axis == axis);
}

}  // namespace

TEST_CASE("An LM-63 file is read as it stands", "[light][ies]") {
    const PhotometricFile file = read_text("a.ies", plain);
    CHECK(file.format == "IES LM-63-2002");
    CHECK(file.manufacturer == "Maker");
    CHECK(file.report_number == "1");
    CHECK(file.date == "today");
    CHECK(file.deviations.empty());
    CHECK(file.notes.empty());
    CHECK(file.symmetry == "C0-C180 and C90-C270");
    CHECK(file.stored_planes == 3);
    CHECK_FALSE(file.absolute);
    CHECK(file.stated_flux_lm == 1000.0);
    CHECK(file.input_power_w == 40.0);
    CHECK_THAT(*file.light_output_ratio, WithinRel(file.integrated_flux_lm / 1000.0, 1e-15));
    // Length along C0 (x), width along C90 (y).
    check_opening(file.opening, Kind::rectangle, {1.2, 0.3, 0.0});
    for (const double c : {45.0, 135.0, 225.0, 315.0}) {
        CHECK_THAT(intensity_cd(file, c, 45), WithinRel(70.0, 1e-12));
        CHECK_THAT(intensity_cd(file, c, 90), WithinRel(20.0, 1e-12));
    }
    CHECK_THAT(intensity_cd(file, 180, 45), WithinRel(80.0, 1e-12));
    CHECK_THAT(intensity_cd(file, 270, 45), WithinRel(60.0, 1e-12));
    CHECK(intensity_cd(file, 0, 91) == 0.0);
}

TEST_CASE("Factors are applied as their edition says", "[light][ies]") {
    const std::string factors = replaced(plain, "1 1 40", "0.5 0.8 40");
    const std::string scaled = replaced(factors, "2 500 1 3", "2 500 10 3");
    CHECK_THAT(read_text("a.ies", scaled).intensity.max_intensity_cd(), WithinRel(400.0, 1e-12));
    const std::string recent = replaced(scaled, "IESNA:LM-63-2002", "IES:LM-63-2019");
    const std::string generated = replaced(recent, "0.8 40", "1.10100 40");
    const PhotometricFile file = read_text("a.ies", generated);
    CHECK_THAT(file.intensity.max_intensity_cd(), WithinRel(500.0, 1e-12));
    CHECK(mentions(file.notes, "test in an accredited laboratory, scaled in flux"));
    const PhotometricFile simulated = read_text("a.ies", replaced(recent, "0.8 40", "1.00010 40"));
    CHECK(mentions(simulated.notes, "computer simulation"));
}

TEST_CASE("Each edition has its own table of luminous openings", "[light][ies]") {
    const char* e1986 = "A label of 1986";
    const char* e1991 = "IESNA91";
    const char* e1995 = "IESNA:LM-63-1995";
    const char* e2002 = "IESNA:LM-63-2002";
    const char* e2019 = "IES:LM-63-2019";
    for (const char* edition : {e1986, e1991, e1995, e2002, e2019}) {
        check_opening(opening_of(edition, "0 0 0"), Kind::point, {0, 0, 0});
        check_opening(opening_of(edition, "1 2 0"), Kind::rectangle, {2, 1, 0});
        const Opening box = opening_of(edition, "1 2 3");
        check_opening(box, Kind::box, {2, 1, 3});
        CHECK(box.side_heights_m == std::array<double, 4>{3, 3, 3, 3});
    }
    for (const char* edition : {e1986, e1991}) {
        check_opening(opening_of(edition, "-1 0 0"), Kind::ellipse, {1, 1, 0});
        check_opening(opening_of(edition, "-1 0 2"), Kind::cylinder, {1, 1, 2});
        check_opening(opening_of(edition, "-1 2 0"), Kind::ellipse, {2, 1, 0});
        check_opening(opening_of(edition, "-1 2 3"), Kind::ellipsoid, {2, 1, 3});
    }
    check_opening(opening_of(e1995, "-1 0 0"), Kind::ellipse, {1, 1, 0});
    check_opening(opening_of(e1995, "-1 0 -1"), Kind::ellipsoid, {1, 1, 1});
    check_opening(opening_of(e1995, "-1 0 2"), Kind::cylinder, {1, 1, 2});
    check_opening(opening_of(e1995, "0 2 -1"), Kind::cylinder, {2, 1, 1}, Axis::x);
    check_opening(opening_of(e1995, "2 0 -1"), Kind::cylinder, {1, 2, 1}, Axis::y);
    check_opening(opening_of(e1995, "-1 2 3"), Kind::cylinder, {2, 1, 3});
    check_opening(opening_of(e1995, "1 -2 3"), Kind::cylinder, {2, 1, 3});
    check_opening(opening_of(e1995, "1 -2 -3"), Kind::ellipsoid, {2, 1, 3});
    for (const char* edition : {e2002, e2019}) {
        check_opening(opening_of(edition, "-1 -1 0"), Kind::ellipse, {1, 1, 0});
        check_opening(opening_of(edition, "-1 -2 0"), Kind::ellipse, {2, 1, 0});
        check_opening(opening_of(edition, "-1 -2 3"), Kind::cylinder, {2, 1, 3});
        check_opening(opening_of(edition, "-1 -2 -3"), Kind::ellipsoid, {2, 1, 3});
        check_opening(opening_of(edition, "-1 2 -1"), Kind::cylinder, {2, 1, 1}, Axis::x);
        check_opening(opening_of(edition, "2 -1 -1"), Kind::cylinder, {1, 2, 1}, Axis::y);
        check_opening(opening_of(edition, "-1 0 -2"), Kind::ellipse, {0, 1, 2}, Axis::x);
    }
    // An opening of another edition is read, and said to be so.
    const PhotometricFile file = read_text("a.ies", with_opening(e2002, "-1 0 0"));
    check_opening(file.opening, Kind::ellipse, {1, 1, 0});
    CHECK(mentions(file.deviations,
                   "line 7: the dimensions -1, 0, 0 m name no opening of LM-63-2002"));
    const PhotometricFile wall = read_text("a.ies", with_opening(e2002, "0 2 1"));
    check_opening(wall.opening, Kind::rectangle, {2, 0, 1}, Axis::y);
    CHECK(mentions(wall.deviations, "vertical rectangle facing C90"));
    CHECK_THAT(complaints("a.ies", with_opening(e2002, "-1 2 0.5 ")),
               Contains("nothing"));  // an ellipse of 1995
    CHECK_THAT(complaints("a.ies", with_opening(e2002, "1 2 -3")),
               Contains("a.ies:7:17: the dimensions 1, 2, -3 m name no luminous opening"));
}

TEST_CASE("Lengths are in feet or metres", "[light][ies]") {
    const PhotometricFile file = read_text("a.ies", replaced(plain, "3 3 1 2 0.3", "3 3 1 1 0.3"));
    check_opening(file.opening, Kind::rectangle, {1.2 * 0.3048, 0.3 * 0.3048, 0.0});
}

TEST_CASE("Planes are unfolded to the full circle", "[light][ies]") {
    const auto file_with = [](const std::string& angles, const std::string& rows, int n) {
        return replaced(replaced(replaced(plain, "3 3 1 2", "3 " + std::to_string(n) + " 1 2"),
                                 "0 45 90\n0 45 90\n", "0 45 90\n" + angles + "\n"),
                        "100 80 10\n100 70 20\n100 60 30\n", rows);
    };
    const PhotometricFile rotational = read_text("a.ies", file_with("0", "9 8 7\n", 1));
    CHECK(rotational.symmetry == "rotational");
    CHECK_THAT(intensity_cd(rotational, 217, 45), WithinRel(8.0, 1e-12));

    const PhotometricFile half = read_text("a.ies", file_with("0 90 180", "9 8 7 9 6 5 9 4 3", 3));
    CHECK(half.symmetry == "C0-C180");
    CHECK_THAT(intensity_cd(half, 270, 45), WithinRel(6.0, 1e-12));
    CHECK_THAT(intensity_cd(half, 315, 45), WithinRel(7.0, 1e-12));
    CHECK_THAT(intensity_cd(half, 180, 45), WithinRel(4.0, 1e-12));

    const PhotometricFile other =
        read_text("a.ies", file_with("90 135 180 270", "9 1 1 9 2 2 9 3 3 9 4 4", 4));
    CHECK(other.symmetry == "C90-C270");
    CHECK_THAT(intensity_cd(other, 45, 45), WithinRel(2.0, 1e-12));
    CHECK_THAT(intensity_cd(other, 0, 45), WithinRel(3.0, 1e-12));
    CHECK_THAT(intensity_cd(other, 315, 45), WithinRel(3.5, 1e-12));

    const std::string full_rows = "9 1 1 9 2 2 9 3 3 9 4 4 9 1 1";
    const PhotometricFile full = read_text("a.ies", file_with("0 90 180 270 360", full_rows, 5));
    CHECK(full.symmetry == "none");
    CHECK_THAT(intensity_cd(full, 315, 45), WithinRel(2.5, 1e-12));

    const PhotometricFile open =
        read_text("a.ies", file_with("0 90 180 270", "9 1 1 9 2 2 9 3 3 9 4 4", 4));
    CHECK(mentions(open.deviations, "the last plane is at 270"));
    CHECK_THAT(open.integrated_flux_lm, WithinRel(full.integrated_flux_lm, 1e-12));

    CHECK_THAT(complaints("a.ies", file_with("0 60 120", "9 1 1 9 2 2 9 3 3", 3)),
               Contains("a.ies:10:1: horizontal angles from 0 to 120; expected 0 alone"));
    const PhotometricFile torn =
        read_text("a.ies", file_with("0 90 180 270 360", "9 1 1 9 2 2 9 3 3 9 4 4 5 3 1", 5));
    CHECK(mentions(torn.deviations, "intensities at gamma = 0 differ"));
    CHECK(mentions(torn.deviations, "planes C0 and C360 differ by up to 4 cd"));
}

TEST_CASE("Types A and B are turned into the C-gamma system", "[light][ies]") {
    // A narrow beam at H = 20, V = 10 in a dark field.
    const auto beam = [](int type) {
        std::string text =
            replaced(plain, "3 3 1 2 0.3 1.2 0", fmt::format("181 181 {} 2 0 0 0", type));
        text = text.substr(0, text.find("0 45 90"));
        for (int list = 0; list < 2; ++list) {
            for (int angle = -90; angle <= 90; ++angle) text += fmt::format("{} ", angle);
            text += "\n";
        }
        for (int h = -90; h <= 90; ++h) {
            for (int v = -90; v <= 90; ++v) {
                const double r2 = (h - 20) * (h - 20) + (v - 10) * (v - 10);
                text += fmt::format("{:.4f} ", 1000.0 * std::exp(-r2 / 100.0));
            }
            text += "\n";
        }
        return read_text("a.ies", text);
    };
    const auto direction = [](double h_deg, double v_deg, bool type_b) {
        return type_b ? optics::type_b_direction({h_deg, v_deg})
                      : optics::type_a_direction({h_deg, v_deg});
    };
    for (const bool type_b : {false, true}) {
        const PhotometricFile file = beam(type_b ? 2 : 3);
        CHECK(file.photometric_type == (type_b ? "B" : "A"));
        for (const double h : {20.0, 25.0, 8.0, -10.0}) {
            for (const double v : {10.0, 17.0, -3.0}) {
                const double r2 = (h - 20) * (h - 20) + (v - 10) * (v - 10);
                // Both interpolations cut the curvature: 2 h^2 / 8 * 20 cd/deg^2 at most.
                CHECK_THAT(file.intensity.intensity_cd(direction(h, v, type_b)),
                           WithinAbs(1000.0 * std::exp(-r2 / 100.0), 8.0));
            }
        }
        // Flux by midpoints in the goniometer's own angles: the sphere element is cos V in type A
        // and cos H in type B, where the other angle turns around the pole.
        double flux = 0.0;
        for (double h = -89.75; h < 90.0; h += 0.5) {
            for (double v = -89.75; v < 90.0; v += 0.5) {
                const double r2 = (h - 20) * (h - 20) + (v - 10) * (v - 10);
                const double latitude = (type_b ? h : v) * pi / 180.0;
                flux += 1000.0 * std::exp(-r2 / 100.0) * std::cos(latitude);
            }
        }
        flux *= std::pow(0.5 * pi / 180.0, 2);
        // Interpolation between points 1 deg apart widens a Gaussian of 7 deg by about 0.3 %.
        CHECK_THAT(file.integrated_flux_lm, WithinRel(flux, 6e-3));
    }
}

TEST_CASE("Half a type B file is mirrored in H", "[light][ies]") {
    const std::string text =
        replaced(replaced(replaced(plain, "3 3 1 2 0.3 1.2 0", "3 2 2 2 0 0 0"),
                          "0 45 90\n0 45 90\n", "-90 0 90\n0 90\n"),
                 "100 80 10\n100 70 20\n100 60 30\n", "10 100 20 5 50 10");
    const PhotometricFile file = read_text("a.ies", text);
    CHECK(file.symmetry == "H");
    for (const double h : {-45.0, 45.0}) {
        CHECK_THAT(file.intensity.intensity_cd(optics::type_b_direction({h, 0.0})),
                   WithinRel(75.0, 1e-9));
    }
}

TEST_CASE("The tilt factor of the photometric position is applied", "[light][ies]") {
    const std::string include =
        replaced(plain, "TILT=NONE", "TILT=INCLUDE\n1\n3\n0 45 90\n0.9 1.0 1.1");
    const PhotometricFile file = read_text("a.ies", include);
    CHECK_THAT(file.intensity.max_intensity_cd(), WithinRel(90.0, 1e-12));
    CHECK(mentions(file.notes, "the tilt factor at 0 deg, 0.9, is applied"));

    const ScratchFolder folder;
    folder.write("lamp.tlt", "2\n2\n0 90\n0.8, 1\n");
    const auto path = folder.write("a.ies", replaced(plain, "TILT=NONE", "TILT=..\\x\\lamp.tlt"));
    CHECK_THAT(read_photometric_file(path).intensity.max_intensity_cd(), WithinRel(80.0, 1e-12));
    CHECK_THAT(complaints("a.ies", replaced(plain, "TILT=NONE", "TILT=gone.tlt")),
               Contains("gone.tlt: cannot be read"));
    CHECK_THAT(complaints("a.ies", replaced(include, "0 45 90\n0.9", "10 45 90\n0.9")),
               Contains("a.ies:9:1: the tilt data have no factor at 0 deg"));
    CHECK_THAT(complaints("a.ies", replaced(include, "INCLUDE\n1\n", "INCLUDE\n4\n")),
               Contains("a.ies:7:1: the lamp-to-luminaire geometry is 4; expected 1, 2 or 3"));
}

TEST_CASE("Text may be laid out and encoded in many ways", "[light][ies]") {
    const PhotometricFile reference = read_text("a.ies", plain);
    std::string crlf;
    for (const char c : plain) crlf += c == '\n' ? std::string("\r\n") : std::string(1, c);
    const std::vector<std::string> variants = {
        crlf, "\xEF\xBB\xBF" + plain, plain + "\x1A",
        replaced(plain, "100 80 10\n100 70 20", "100, 80,10 100\n\n\n\t70\n+20"),
        replaced(plain, "100 60 30\n", "1e2 6.0E+01 30")};
    for (const std::string& variant : variants) {
        const PhotometricFile file = read_text("a.ies", variant);
        CHECK(file.deviations.empty());
        CHECK(file.integrated_flux_lm == reference.integrated_flux_lm);
    }
    const PhotometricFile latin = read_text("a.ies", replaced(plain, "Maker",
                                                              "Gr\xFC\xDF"
                                                              "e \x80"));
    CHECK(latin.manufacturer ==
          "Gr\xC3\xBC\xC3\x9F"
          "e \xE2\x82\xAC");
    // Decided by content, whatever the name.
    CHECK(read_text("noname", plain).format == "IES LM-63-2002");
    CHECK(read_text("wrong.ldt", plain).format == "IES LM-63-2002");
}

TEST_CASE("Keywords are kept, and continued by MORE", "[light][ies]") {
    const PhotometricFile file = read_photometric_file(data_file("viewer_label_lines.ies"));
    CHECK(file.format == "IES LM-63-1995");
    CHECK(file.catalogue_number == "BD0150");
    const auto found = std::find_if(file.keywords.begin(), file.keywords.end(),
                                    [](const auto& entry) { return entry.first == "MULTILINE"; });
    REQUIRE(found != file.keywords.end());
    CHECK(found->second ==
          "Test multiline metadata\nShould contain three lines\nDivided by LF characters");
    const PhotometricFile bare = read_text("a.ies", replaced(plain, "[TESTLAB] here\n", "words\n"));
    CHECK(mentions(bare.deviations, "line 3: text without a [KEYWORD]"));
    CHECK(mentions(bare.deviations, "the required keyword [TESTLAB] is missing"));
}

TEST_CASE("Absolute photometry has no lamp flux", "[light][ies]") {
    const PhotometricFile file =
        read_photometric_file(data_file("viewer_absolute_photometry_with_multiplier.ies"));
    CHECK(file.absolute);
    CHECK_FALSE(file.stated_flux_lm);
    CHECK_FALSE(file.light_output_ratio);
    CHECK_THAT(intensity_cd(file, 0, 0), WithinRel(2200.0 * 1.5, 1e-12));
    check_opening(file.opening, Kind::ellipse, {0.12, 0.12, 0.0});
    CHECK(file.deviations.empty());
    const PhotometricFile relative =
        read_photometric_file(data_file("viewer_relative_photometry.ies"));
    CHECK(mentions(relative.deviations, "line 14: the luminaire emits 180.9 % of the flux"));
}

TEST_CASE("Real files are read, and what is odd about them is said", "[light][ies]") {
    const PhotometricFile pendant = read_photometric_file(data_file("ledalite_pendant.ies"));
    CHECK(mentions(pendant.deviations, "\"IESNA95\" is not the identifier \"IESNA:LM-63-1995\""));
    CHECK(mentions(pendant.deviations, "line 2: text without a [KEYWORD]"));
    CHECK(pendant.deviations.size() == 2);
    CHECK_THAT(*pendant.light_output_ratio, WithinAbs(0.913, 0.001));
    // "0 degree plane parallel to lamps": the length of 4.04 ft runs along C0.
    check_opening(pendant.opening, Kind::box, {4.04 * 0.3048, 0.85 * 0.3048, 0.292 * 0.3048});
    CHECK(read_photometric_file(data_file("bollard.ies")).deviations.empty());
    CHECK(mentions(read_photometric_file(data_file("cylinder_wide.ies")).deviations,
                   "\" IESNA:LM-63-1995\" is not the identifier"));
    const PhotometricFile lamp = read_photometric_file(data_file("soft_display.ies"));
    CHECK(lamp.format == "IES LM-63-1986");
    CHECK(lamp.deviations.empty());
    CHECK(mentions(read_photometric_file(data_file("speos_detector.ies")).deviations,
                   "IESNA:LM-63-95"));
}

TEST_CASE("Errors of an LM-63 file have a place and come together", "[light][ies]") {
    CHECK(complaints("a.ies", "") == "a.ies:1:1: is empty\n");
    CHECK_THAT(complaints("a.ies", "IESNA:LM-63-2002\n[TEST] 1\n"),
               Contains("a.ies:2:1: the file has no line that begins with TILT="));
    CHECK_THAT(complaints("a.ies", plain.substr(0, plain.size() - 4)),
               Contains("the file ends after 8 of the 9 values of intensity"));
    CHECK_THAT(complaints("a.ies", plain.substr(0, plain.find("1 1 40") + 4)),
               Contains("the file ends where the input power should stand"));
    const std::string garbled =
        replaced(replaced(plain, "100 70 20", "100 7O 20"), "60 30", "-60 nan");
    CHECK(complaints("a.ies", garbled) ==
          "a.ies:12:5: \"7O\" stands for an intensity at horizontal angle 45; expected a number\n"
          "a.ies:13:9: \"nan\" stands for an intensity at horizontal angle 90; expected a number\n"
          "a.ies:13:5: the intensity -60 is negative; expected 0 cd or more\n");
    CHECK_THAT(complaints("a.ies", replaced(plain, "0 45 90\n0 45", "0 45 45\n0 45")),
               Contains("a.ies:9:6: vertical angles must increase; 45 follows 45"));
    CHECK_THAT(complaints("a.ies", replaced(plain, "0 45 90\n0 45", "0 45 190\n0 45")),
               Contains("a.ies:9:6: the vertical angle 190 is outside 0 to 180 deg"));
    const std::string header =
        complaints("a.ies", replaced(plain, "2 500 1 3 3 1 2", "2 500 -1 1 3.5 9 7"));
    CHECK_THAT(header, Contains("a.ies:7:7: the candela multiplier is -1; expected above 0"));
    CHECK_THAT(header,
               Contains("the number of vertical angles is 1; expected a whole number from 2"));
    CHECK_THAT(header, Contains("the number of horizontal angles is 3.5"));
    CHECK_THAT(header, Contains("the photometric type is 9; expected 1 (type C), 2 (type B) or 3"));
    CHECK_THAT(header, Contains("the unit of length is 7; expected 1 (feet) or 2 (metres)"));
    CHECK_THAT(complaints("a.ies", replaced(plain, "3 3 1 2", "20000 20000 1 2")),
               Contains("the file ends after"));
    CHECK_THAT(complaints("a.ies", replaced(replaced(replaced(plain, "100 80 10", "0 0 0"),
                                                     "100 70 20", "0 0 0"),
                                            "100 60 30", "0 0 0")),
               Contains("all intensities are 0"));
    CHECK(mentions(read_text("a.ies", plain + "1 2 3\n").deviations,
                   "line 14: 3 more words follow the last intensity"));
}
