// The command bench. Nothing here depends on how fast the machine is.
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "io/atomic_file.h"
#include "tests/cli/run_program.h"
#include "tests/io/example_result.h"

using namespace lucerna;
using namespace lucerna::cli;
using Catch::Contains;
using io::ScratchFolder;
using nlohmann::json;

namespace {

// A lamp over a table, with a ball of glass for a caustic, seen by what is given.
std::string scene_seen_by(const std::string& observer) {
    return "lucerna: 1\n"
           "up: z\n"
           "materials:\n"
           "  oak: {type: diffuse, reflectance: 0.5}\n"
           "  glass: {type: dielectric, index: 1.5, absorption: 0 1/m}\n"
           "objects:\n"
           "  - {name: table, material: oak, shape: {type: rectangle, center: [0 m, 0 m, 0 m], "
           "size: [2 m, 2 m], normal: z, up: y}}\n"
           "  - {name: wall, material: oak, shape: {type: rectangle, center: [0 m, 1 m, 1 m], "
           "size: [2 m, 2 m], normal: -y, up: z}}\n"
           "  - {name: ball, material: glass, shape: {type: sphere, center: [0 m, 0 m, 0.3 m], "
           "radius: 0.2 m}}\n"
           "  - {name: panel, material: oak, shape: {type: disk, center: [0 m, 0 m, 1.5 m], "
           "normal: -z, radius: 100 mm}}\n"
           "lights:\n"
           "  - {name: lamp, type: area, on: panel, side: front, flux: 1000 lm, spectrum: E}\n" +
           observer + "\nsimulation: {seed: 7}\n";
}

const std::string camera =
    "cameras:\n"
    "  - {name: view, type: perspective, from: [0 m, -3 m, 1.6 m], to: [0 m, 0 m, 0.3 m], "
    "fov: 45 deg, resolution: [16, 12]}";
const std::string sensor =
    "sensors:\n"
    "  - {name: below the lamp, type: illuminance, position: [0.5 m, 0 m, 1 mm], normal: z}";

// A benchmark that takes no time.
std::vector<std::string> quick(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "bench");
    for (const char* more : {"--paths", "300", "--repetitions", "2"}) arguments.push_back(more);
    return arguments;
}

bool is_rate(const json& rate, std::size_t columns) {
    if (rate["items"] == 0 || rate["per_s"].size() != columns) return false;
    return std::all_of(rate["per_s"].begin(), rate["per_s"].end(),
                       [](const json& per_s) { return per_s.get<double>() > 0.0; });
}

}  // namespace

TEST_CASE("A benchmark says on the terminal what was measured", "[cli]") {
    ScratchFolder folder;
    io::write_file(folder / "ball.yaml", scene_seen_by(camera));
    const Outcome outcome =
        run_program(quick({folder / "ball.yaml", "--threads", "1,2", "--phases", "2"}));
    CAPTURE(outcome.err);
    REQUIRE(outcome.exit_code == 0);
    for (const char* row : {"ball.yaml",
                            "1 thread",
                            "2 threads",
                            "forward rays, bare cast",
                            "forward rays, traced",
                            "traced / bare",
                            "backward rays, bare cast",
                            "backward rays, traced",
                            "backward map, vertices built in",
                            "backward map, photons looked up",
                            "backward map, deposits applied",
                            "caustic map, photons built in",
                            "caustic map, gathers",
                            "indirect map, photons built in",
                            "indirect map, gathers",
                            "method",
                            "automatic",
                            "scheduler",
                            "ordered",
                            "threads",
                            "setup",
                            "pilot phases",
                            "a phase",
                            "forward traces for maps",
                            "maps built",
                            "backward trace",
                            "secondary trace, deposits",
                            "images",
                            "rest",
                            "whole run",
                            "noise δ",
                            "memory of maps and images",
                            "memory of the process",
                            "speed-up",
                            "maps and images, relative"}) {
        CHECK_THAT(outcome.out, Contains(row));
    }
    CHECK_THAT(outcome.out, !Contains("time to") && !Contains("Written"));
}

TEST_CASE("A benchmark leaves all of its numbers as JSON", "[cli]") {
    ScratchFolder folder;
    io::write_file(folder / "ball.yaml", scene_seen_by(camera));
    io::write_file(folder / "point.yaml", scene_seen_by(sensor));
    const Outcome outcome =
        run_program(quick({"--threads", "1,2", "--method", "combined,path", "--scheduler",
                           "ordered", folder / "ball.yaml", folder / "point.yaml", "--phases", "2",
                           "-o", folder / "new/bench.json"}));
    CAPTURE(outcome.err);
    REQUIRE(outcome.exit_code == 0);
    CHECK_THAT(outcome.out, Contains("new/bench.json"));
    const json bench = json::parse(io::read_text(folder / "new/bench.json"));
    CHECK(bench["hardware_threads"].get<int>() >= 1);
    CHECK(bench["plan"]["repetitions"] == 2);
    CHECK(bench["plan"]["phases"] == 2);
    CHECK(bench["plan"]["delta"].is_null());
    REQUIRE(bench["scenes"].size() == 2);
    CHECK(bench["scenes"][0]["scene"] == (folder / "ball.yaml").string());
    CHECK(bench["scenes"][0]["scene_hash"] != bench["scenes"][1]["scene_hash"]);
    CHECK(bench["scenes"][0]["seed"] == 7);

    const json& rates = bench["scenes"][0]["rates"];
    CHECK(rates["threads"] == json({1, 2}));
    for (const char* trace : {"forward_rays", "backward_rays"}) {
        CHECK(is_rate(rates[trace]["bare"], 2));
        CHECK(is_rate(rates[trace]["traced"], 2));
        CHECK(rates[trace]["fraction"].size() == 2);
    }
    CHECK(is_rate(rates["backward_map"]["build"], 2));
    CHECK(is_rate(rates["backward_map"]["find"], 2));
    CHECK(is_rate(rates["backward_map"]["deposit"], 2));
    for (const char* map : {"caustic_map", "indirect_map"}) {
        CHECK(is_rate(rates[map]["build"], 2));
        CHECK(is_rate(rates[map]["gather"], 2));
    }

    for (const json& scene : bench["scenes"]) {
        REQUIRE(scene["runs"].size() == 4);
        CHECK(scene["runs"][0]["relative_to_first"]["speed_up"] == 1.0);
        for (std::size_t i = 0; i < 4; ++i) {
            const json& run = scene["runs"][i];
            CHECK(run["method"] == (i < 2 ? "combined" : "path"));
            CHECK(run["scheduler"] == "ordered");
            CHECK(run["threads"] == (i % 2 == 0 ? 1 : 2));
            REQUIRE(run["repetitions"].size() == 2);
            for (const json& measure : run["repetitions"]) {
                CHECK(measure["phases"] == 2);
                CHECK(measure["stopped_by"] == "phases");
                CHECK(measure["delta"].is_null() == (&scene == &bench["scenes"][1]));
                CHECK(measure["peak_memory_bytes"].get<double>() >
                      measure["backward_map_bytes"].get<double>());
                double stages_s = 0.0;
                for (const json& stage_s : measure["stages_s"]) stages_s += stage_s.get<double>();
                CHECK(stages_s == Approx(measure["wall_s"].get<double>()));
                // No stage counts what another one counts.
                CHECK(measure["stages_s"]["rest"].get<double>() >= 0.0);
            }
        }
        // The same work whatever the number of threads.
        CHECK(scene["runs"][0]["repetitions"][0]["deposits"] ==
              scene["runs"][1]["repetitions"][1]["deposits"]);
    }
}

TEST_CASE("A benchmark until a noise says whether that was reached", "[cli]") {
    ScratchFolder folder;
    io::write_file(folder / "ball.yaml", scene_seen_by(camera));
    const auto measure = [&](const std::vector<std::string>& options) {
        std::vector<std::string> arguments{folder / "ball.yaml", "-o", folder / "bench.json"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        const Outcome outcome = run_program(quick(arguments));
        CAPTURE(outcome.err);
        REQUIRE(outcome.exit_code == 0);
        CHECK_THAT(outcome.out, Contains("time to δ"));
        const json bench = json::parse(io::read_text(folder / "bench.json"));
        const json measured = bench["scenes"][0]["runs"][0]["repetitions"][0];
        if (measured["delta_reached"] == true) {
            CHECK_THAT(outcome.out, !Contains("extrapolated"));
        } else {
            CHECK_THAT(outcome.out, Contains("extrapolated"));
        }
        return measured;
    };
    const json easy = measure({"--delta", "90%"});
    CHECK(easy["delta_reached"] == true);
    CHECK(easy["time_to_delta_s"] == easy["wall_s"]);
    CHECK(easy["stopped_by"] == "accuracy");

    const json limited = measure({"--delta", "0.001%", "--time-limit", "0.001s"});
    CHECK(limited["delta_reached"] == false);
    CHECK(limited["stopped_by"] == "time limit");

    const json few = measure({"--delta", "0.001%", "--phases", "3"});
    CHECK(few["delta_reached"] == false);
    CHECK(few["stopped_by"] == "phases");
    CHECK(few["extrapolated_time_to_delta_s"].get<double>() > few["wall_s"].get<double>());
}

TEST_CASE("A benchmark compares all schedulers", "[cli]") {
    ScratchFolder folder;
    io::write_file(folder / "ball.yaml", scene_seen_by(camera));
    const Outcome outcome = run_program(quick(
        {folder / "ball.yaml", "--scheduler", "ordered,synchronous,asynchronous,two-level",
         "--threads", "2", "--method", "combined", "--phases", "2", "-o", folder / "b.json"}));
    CAPTURE(outcome.err);
    REQUIRE(outcome.exit_code == 0);
    const json runs = json::parse(io::read_text(folder / "b.json"))["scenes"][0]["runs"];
    REQUIRE(runs.size() == 4);
    for (const json& run : runs) {
        CHECK_THAT(outcome.out, Contains(run["scheduler"].get<std::string>()));
        CHECK(run["repetitions"][0]["phases"] == 2);
    }
}

TEST_CASE("What a benchmark cannot do is refused before it starts", "[cli]") {
    ScratchFolder folder;
    io::write_file(folder / "ball.yaml", scene_seen_by(camera));
    io::write_file(folder / "point.yaml", scene_seen_by(sensor));
    const std::string ball = folder / "ball.yaml";
    const std::string point = folder / "point.yaml";
    const std::string none = folder / "none.yaml";
    const std::string path = folder.path();
    using Options = std::vector<std::string>;
    const std::vector<std::pair<Options, std::string>> refused{
        {Options(), "SCENE"},
        {Options{none}, "none.yaml"},
        {Options{ball, none}, "none.yaml"},
        {Options{ball, "--threads", "1,0"}, "--threads"},
        {Options{ball, "--threads", "two"}, "--threads"},
        {Options{ball, "--method", "combined,magic"}, "--method"},
        {Options{ball, "--scheduler", "magic"}, "--scheduler"},
        {Options{ball, "--phases", "0"}, "--phases"},
        {Options{ball, "--repetitions", "0"}, "--repetitions"},
        {Options{ball, "--delta", "5"}, "has no unit"},
        {Options{ball, "--time-limit", "5s"}, "--delta"},
        {Options{point, "--delta", "5%"}, "no camera"},
        {Options{ball, "-o", path}, "is a folder"},
        {Options{ball, "-o", ball + "/bench.json"}, "ball.yaml"},
    };
    for (const auto& [options, message] : refused) {
        std::vector<std::string> arguments{"bench"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        const Outcome outcome = run_program(arguments);
        CHECK(outcome.exit_code == 2);
        CHECK_THAT(outcome.err, Contains(message));
        CHECK(outcome.out.empty());
    }
}
