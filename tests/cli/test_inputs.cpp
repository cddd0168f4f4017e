// What stated uncertainties of inputs make of the values of a run.
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "io/atomic_file.h"
#include "tests/cli/run_program.h"
#include "tests/io/example_result.h"

using namespace lucerna;
using namespace lucerna::cli;
using Catch::Contains;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;
using io::read_text;
using io::ScratchFolder;
using nlohmann::json;

namespace {

// A lamp in the middle of an integrating sphere: E = flux / (4 pi r^2 (1 - rho)).
std::string sphere(const std::string& reflectance, const std::string& flux) {
    return R"(lucerna: 1
up: z
materials:
  white: {type: diffuse, reflectance: )" +
           reflectance + R"(}
objects:
  - {name: wall, material: white, shape: {type: sphere, center: [0 m, 0 m, 0 m], radius: 1 m}}
lights:
  - {name: lamp, type: point, position: [0 m, 0 m, 0 m], flux: )" +
           flux + R"(, spectrum: E}
sensors:
  - {name: wall, type: illuminance, position: [0 m, 0 m, -0.9999 m], normal: z}
  - {name: received, type: flux, on: wall}
)";
}

struct SphereRuns {
    ScratchFolder folder;
    std::string scene = folder / "sphere.yaml";

    Outcome run(const std::string& text, std::vector<std::string> options = {"--phases", "40"}) {
        io::write_file(scene, text);
        options.insert(options.begin(), {"run", scene, "-o", folder / "results"});
        return run_program(options);
    }
    json report() const { return json::parse(read_text(folder / "results/report.json")); }
};

}  // namespace

TEST_CASE("Stated uncertainties of inputs come out as those of the values", "[cli][analytic]") {
    SphereRuns runs;
    const Outcome outcome = runs.run(sphere("0.5 ± 0.02", "1000 lm ± 5 %"));
    CAPTURE(outcome.err);
    REQUIRE(outcome.exit_code == 0);
    const json report = runs.report();
    REQUIRE(report["uncertain_inputs"].size() == 2);
    CHECK_THAT(report["uncertain_inputs"][0].get<std::string>(),
               Contains("materials.white.reflectance: 0.5 ± 0.02"));
    // (1 - 0.5) / (1 - 0.52) - 1, and not 0.02 / 0.5. Shared random numbers leave a percent of
    // noise to that.
    const double of_reflectance = 0.5 / 0.48 - 1.0;
    for (const std::size_t i : {0u, 2u}) {  // illuminance, flux received inside
        const json& quantity = report["quantities"][i];
        const double value = quantity["value"];
        const json& changes = quantity["input_changes"];
        CHECK_THAT(changes[0]["change"].get<double>() / value, WithinAbs(of_reflectance, 8e-4));
        CHECK_THAT(changes[1]["change"].get<double>() / value, WithinAbs(0.05, 1e-6));
        const double of_inputs = quantity["input_uncertainty"];
        CHECK_THAT(of_inputs / value, WithinAbs(std::hypot(of_reflectance, 0.05), 8e-4));
        CHECK_THAT(quantity["combined_uncertainty"].get<double>(),
                   WithinRel(std::hypot(of_inputs, quantity["expanded_uncertainty"].get<double>()),
                             1e-12));
    }
    CHECK_THAT(outcome.out, Contains("Uncertain inputs") && Contains("combined"));
}

TEST_CASE("The values themselves do not depend on stated uncertainties", "[cli]") {
    SphereRuns runs;
    runs.run(sphere("0.5 ± 0.02", "1000 lm ± 5 %"), {"--phases", "3"});
    const json with = runs.report()["quantities"];
    runs.run(sphere("0.5", "1000 lm"), {"--phases", "3"});
    const json without = runs.report()["quantities"];
    CHECK(with[0]["value"] == without[0]["value"]);
    CHECK(with[0]["expanded_uncertainty"] == without[0]["expanded_uncertainty"]);
    CHECK_FALSE(without[0].contains("input_uncertainty"));
}

TEST_CASE("Limits of the run do not end the runs with shifted inputs at other phases", "[cli]") {
    SphereRuns runs;
    // With less reflected light the accuracy is reached after fewer phases.
    runs.run(sphere("0.95 ± 0.5", "1000 lm ± 5 %"), {"--accuracy", "0.5%", "--time", "2s"});
    const json report = runs.report();
    CHECK(report["uncertain_inputs"].size() == 2);
    INFO(report["warnings"].dump());
    CHECK_THAT(report["warnings"].dump(), !Contains("interrupted"));
    // A busy machine may finish a single phase in that time, and warn that it has no error.
    if (report["phases"] > 1) CHECK(report["warnings"].empty());
}

TEST_CASE("A number that is used twice is one input", "[cli]") {
    SphereRuns runs;
    std::string text = sphere("&rho 0.5 ± 0.02", "1000 lm");
    text.replace(text.find("objects:"), 0, "  other: {type: diffuse, reflectance: *rho}\n");
    REQUIRE(runs.run(text, {"--phases", "3"}).exit_code == 0);
    CHECK(runs.report()["uncertain_inputs"].size() == 1);
    const Outcome check = run_program({"check", runs.scene});
    CHECK_THAT(check.out, Contains("0.5 ± 0.02"));
}

TEST_CASE("A value at its limit is shifted the other way", "[cli]") {
    SphereRuns runs;
    const auto change = [&](const std::string& reflectance) {
        REQUIRE(runs.run(sphere(reflectance, "1000 lm"), {"--phases", "3"}).exit_code == 0);
        return runs.report()["quantities"][0]["input_changes"][0]["change"].get<double>();
    };
    CHECK(change("0 ± 0.02") > 0.0);
    CHECK(change("0.95 ± 0.06") < 0.0);
    const Outcome wide = runs.run(sphere("0.5 ± 0.6", "1000 lm"));
    CHECK(wide.exit_code == 2);
    CHECK_THAT(wide.err, Contains("sphere.yaml:4:") && Contains("up and down"));
}

TEST_CASE("Uncertainties where they mean nothing, or in another unit, are errors", "[cli]") {
    SphereRuns runs;
    const Outcome outcome = runs.run(sphere("0.5 ± 1 lx", "1000 lm ± 5 W") +
                                     "simulation: {accuracy: {sensors: 1 % ± 1 %}}\n");
    CHECK(outcome.exit_code == 2);
    CHECK_THAT(outcome.err, Contains("sphere.yaml:4:") && Contains("sphere.yaml:8:") &&
                                Contains("means nothing here"));
}
