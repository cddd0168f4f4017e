#include <catch2/catch.hpp>

#include "io/atomic_file.h"
#include "tests/cli/run_program.h"
#include "tests/io/example_result.h"

using namespace lucerna;
using namespace lucerna::cli;
using Catch::Contains;
using io::ScratchFolder;

TEST_CASE("Bad options end with code 2 and say what is wrong", "[cli]") {
    const auto [arguments, message] = GENERATE(table<std::vector<std::string>, std::string>({
        {std::vector<std::string>(), "Usage"},
        {{"run"}, "SCENE"},
        {{"fly"}, "fly"},
        {{"run", "--bogus", "room.yaml"}, "--bogus"},
        {{"run", "room.yaml", "--accuracy", "2"}, "has no unit"},
        {{"run", "room.yaml", "--accuracy", "0%"}, "above zero"},
        {{"run", "room.yaml", "--time", "60"}, "has no unit"},
        {{"run", "room.yaml", "--phases", "0"}, "--phases"},
        {{"run", "room.yaml", "--phases", "2.5"}, "--phases"},
        {{"run", "room.yaml", "--seed", "-1"}, "--seed"},
        {{"run", "room.yaml", "--threads", "0"}, "--threads"},
        {{"run", "room.yaml", "--method", "magic"}, "--method"},
        {{"run", "room.yaml", "--spectral", "471"}, "--spectral"},
        {{"compare", "one.exr"}, "IMAGE"},
    }));
    const Outcome outcome = run_program(arguments);
    CHECK(outcome.exit_code == 2);
    CHECK_THAT(outcome.err, Contains(message));
    CHECK(outcome.out.empty());
}

TEST_CASE("Bad input ends with code 2 and names its place", "[cli]") {
    ScratchFolder folder;
    const std::string scene = folder / "room.yaml";
    io::write_file(scene, "lucerna: 1\nmaterials:\n  wall: {type: difuse, reflectance: 0.5}\n");
    for (const char* command : {"run", "check"}) {
        const Outcome outcome = run_program({command, scene});
        CHECK(outcome.exit_code == 2);
        CHECK_THAT(outcome.err, Contains("room.yaml:3:") && Contains("diffuse"));
    }
    CHECK(run_program({"check", folder / "none.yaml"}).exit_code == 2);
    CHECK(run_program({"photometry", scene}).exit_code == 2);
    CHECK(run_program({"compare", scene, scene}).exit_code == 2);
    CHECK_FALSE(std::filesystem::exists(folder / "room-results"));
}

TEST_CASE("Help and version end with code 0", "[cli]") {
    CHECK(run_program({"--help"}).exit_code == 0);
    CHECK_THAT(run_program({"run", "--help"}).out, Contains("--accuracy"));
    CHECK(run_program({"--version"}).out == "lucerna " LUCERNA_VERSION "\n");
}
