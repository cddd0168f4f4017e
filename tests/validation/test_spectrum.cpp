// The spectrum of a prism, read with kernels that are wider than its colours are even.
#include <catch2/catch.hpp>
#include <cmath>

#include "optics/transport/simulate.h"
#include "validation/cases.h"

using namespace lucerna;
using namespace lucerna::validation;

TEST_CASE("U of chromaticity holds what kernels leave of their bias", "[analytic]") {
    const std::vector<Case> cases = prism_cases();
    const auto spectrum = std::ranges::find(cases, "prism/spectrum-2-mm", &Case::id);
    REQUIRE(spectrum != cases.end());
    optics::Settings settings = spectrum->settings;
    settings.seed = 1;
    settings.sensor_accuracy = 0.05;
    settings.max_phases = 24;
    const optics::Result result = optics::simulate(spectrum->scene, settings);
    int readings = 0, missed_by_noise = 0;
    for (const Check& check : spectrum->checks) {
        if (check.quantity != "chromaticity") continue;
        const Reading reading = check.read(result);
        const double off = std::abs(reading.value - check.truth);
        CAPTURE(check.name, reading.value, check.truth, reading.standard_error,
                reading.expanded_uncertainty);
        CHECK(off <= reading.expanded_uncertainty);
        // Wide, but not so wide that it says nothing.
        CHECK(reading.expanded_uncertainty < 0.02);
        ++readings;
        if (off > 2.1 * reading.standard_error) ++missed_by_noise;
    }
    CHECK(readings == 14);
    CHECK(missed_by_noise >= 3);  // the twin: noise alone
}
