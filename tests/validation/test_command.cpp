// lucerna validate as the shell sees it.
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "tests/cli/run_program.h"
#include "tests/io/example_result.h"

using namespace lucerna;
using Catch::Contains;
using cli::run_program;

TEST_CASE("validate lists its cases", "[validation]") {
    const auto outcome = run_program({"validate", "--list", "mirrors"});
    CHECK(outcome.exit_code == 0);
    CHECK_THAT(outcome.out, Contains("mirrors/two-point"));
    CHECK_THAT(outcome.out, !Contains("furnace/"));
}

TEST_CASE("validate complains about unknown cases with the nearest name", "[validation]") {
    const auto outcome = run_program({"validate", "furnce"});
    CHECK(outcome.exit_code == 2);
    CHECK_THAT(outcome.err, Contains("furnce") && Contains("'furnace'"));
    CHECK(outcome.out.empty());
}

TEST_CASE("Daylight of a sky that is not uniform agrees with its truth", "[validation]") {
    CHECK(run_program({"validate", "cie171/5.11-type-8", "cie171/5.9-type-12", "--threads", "1",
                       "--phases", "96"})
              .exit_code == 0);
}

TEST_CASE("Daylight through a pane and past an overhang agrees with its truth", "[validation]") {
    CHECK(run_program({"validate", "cie171/5.10-overcast", "cie171/5.13-depth-1", "--threads", "1",
                       "--phases", "64"})
              .exit_code == 0);
}

TEST_CASE("validate draws cases, and the same again by their seed", "[validation]") {
    const auto outcome = run_program({"validate", "slab", "mirrors/drawn-1", "--draw", "1",
                                      "--seed", "3", "--accuracy", "5%", "--threads", "1"});
    CHECK(outcome.exit_code == 0);
    CHECK_THAT(outcome.out, Contains("slab/drawn-1") && Contains("2 of 2 cases passed"));
    CHECK_THAT(run_program({"validate", "slab/drawn-2", "--draw", "1"}).err,
               Contains("slab/drawn-2"));
}

TEST_CASE("Faint light beside a bright caustic is found", "[validation]") {
    CHECK(run_program({"validate", "ball_lens/faint-ring", "--threads", "1"}).exit_code == 0);
}

TEST_CASE("validate runs a case and writes table, data and page", "[validation]") {
    const io::ScratchFolder folder;
    const std::string results = folder / "results";
    const auto outcome = run_program({"validate", "cie171/5.2-height-3", "--seeds", "2", "--seed",
                                      "5", "--threads", "1", "-o", results});
    CHECK(outcome.exit_code == 0);
    CHECK_THAT(outcome.out, Contains("1 of 1 cases passed") && Contains("Coverage over 2 seeds"));
    const auto json =
        nlohmann::json::parse(io::read_text(std::filesystem::path(results) / "validation.json"));
    CHECK(json["passed"] == true);
    CHECK(json["cases"][0]["runs"][1]["seed"] == 6);
    CHECK_THAT(io::read_text(std::filesystem::path(results) / "validation.html"),
               Contains("</html>"));
}
