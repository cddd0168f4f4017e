#include "io/photometry_report.h"

#include "light_checks.h"
#include "photometry_files.h"

using namespace lucerna;
using namespace lucerna::test;
using Catch::Matchers::Contains;
using Catch::Matchers::EndsWith;

TEST_CASE("The report of an EULUMDAT file says what matters", "[light][golden]") {
    const std::string report = photometry_report(data_file("tulux_box.ldt"));
    CHECK_THAT(report, Contains("format              EULUMDAT\n"));
    CHECK_THAT(report, Contains("manufacturer        Tulux\n"));
    CHECK_THAT(report, Contains("stated flux         1983 lm of the lamps\n"));
    CHECK_THAT(report, Contains("light output ratio  100.01 % (stated: 100.00 %)\n"));
    CHECK_THAT(report, Contains("downward share      86.99 % (stated: 87.00 %)\n"));
    CHECK_THAT(report, Contains("symmetry            C0-C180 and C90-C270\n"));
    CHECK_THAT(report,
               Contains("planes              37 stored, gamma 0 to 180 deg in 73 angles\n"));
    CHECK_THAT(report,
               Contains("opening             box 0.105 x 1.208 x 0.051 m with luminous sides "
                        "of height 0.051, 0, 0.051, 0 m (C0 to C270)\n"));
    // 702.517 cd on 1.208 m x 0.105 m.
    CHECK_THAT(report, Contains("largest intensity   702.517 cd toward C 0, gamma 0 deg\n"));
    CHECK_THAT(report, Contains("luminance           5539 cd/m2 at nadir\n"));
    CHECK_THAT(report, Contains("  1. the file has 2 alternative lamp sets; set 1 applies"));
    CHECK_THAT(report, EndsWith("no deviations from the standard found\n"));
}

TEST_CASE("The report of an IES file numbers its deviations", "[light][golden]") {
    const std::string report = photometry_report(data_file("ledalite_pendant.ies"));
    CHECK_THAT(report, Contains("format              IES LM-63-1995\n"));
    CHECK_THAT(report, Contains("stated flux         5800 lm of the lamps\n"));
    CHECK_THAT(report, Contains("deviations from the standard\n  1. line 1: \"IESNA95\" is not"));
    CHECK_THAT(report, Contains("\n  2. line 2: text without a [KEYWORD]\n"));
    CHECK_THROWS_AS(photometry_report(data_file("missing.ies")), InputError);
}
