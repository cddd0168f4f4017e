// Runs that are stopped and go on, and runs that are joined.
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "io/atomic_file.h"
#include "tests/cli/run_program.h"
#include "tests/io/example_result.h"

using namespace lucerna;
using namespace lucerna::cli;
using Catch::Contains;
using Catch::Matchers::WithinRel;
using io::read_text;
using io::ScratchFolder;
using nlohmann::json;

namespace {

// A glass ball on a table: caustics that sensors and pixels see, and indirect light.
const std::string ball_on_a_table = R"(lucerna: 1
up: z
materials:
  wood: {type: diffuse, reflectance: 0.4}
  glass: {type: dielectric, index: 1.5, absorption: 1 1/m}
objects:
  - {name: table, material: wood, shape: {type: rectangle, center: [0 m, 0 m, 0 m], size: [2 m, 2 m], normal: z, up: y}}
  - {name: ball, material: glass, shape: {type: sphere, center: [0 m, 0 m, 0.3 m], radius: 0.2 m}}
  - {name: panel, material: wood, shape: {type: disk, center: [0 m, 0 m, 1.5 m], normal: -z, radius: 100 mm}}
lights:
  - {name: lamp, type: area, on: panel, side: front, flux: 1000 lm, spectrum: LED-B3}
cameras:
  - {name: view, type: perspective, from: [0 m, -3 m, 1.6 m], to: [0 m, 0 m, 0.3 m], fov: 30 deg, resolution: [24, 16]}
sensors:
  - {name: row, type: illuminance, positions: [[0 m, 0 m, 1 mm], [0.5 m, 0 m, 1 mm]], normal: z}
  - {name: received, type: flux, on: table}
)";

struct Runs {
    ScratchFolder folder;
    std::string scene = folder / "ball.yaml";

    Runs() { io::write_file(scene, ball_on_a_table); }

    std::string path(const std::string& name) const { return folder / name; }
    Outcome run(const std::string& results, std::vector<std::string> options) const {
        options.insert(options.begin(), {"run", scene, "-o", path(results)});
        return run_program(options);
    }
    Outcome merge(const std::vector<std::string>& results, const std::string& output) const {
        std::vector<std::string> arguments{"merge", "-o", path(output)};
        for (const auto& name : results) arguments.push_back(path(name));
        return run_program(arguments);
    }
    json report(const std::string& results) const {
        return json::parse(read_text(path(results) + "/report.json"));
    }
    /// All numbers of a run that do not tell of time or of why it ended: images and report, as
    /// text.
    std::string bits(const std::string& results) const {
        json numbers = report(results);
        for (const char* key : {"wall_s", "rays", "memory", "threads", "stopped_by",
                                "accuracy_reached", "furthest"}) {
            numbers.erase(key);
        }
        return read_text(path(results) + "/view.exr") +
               read_text(path(results) + "/view.spectral.exr") + numbers.dump();
    }
};

}  // namespace

TEST_CASE("A run that is stopped and goes on has the bits of one that is not", "[cli][golden]") {
    const Runs runs;
    // After 64 phases the batches of phases are joined.
    const auto [method, scheduler, phases] = GENERATE(table<std::string, std::string, std::string>(
        {{"automatic", "ordered", "70"}, {"backward", "asynchronous", "7"}}));
    const std::vector<std::string> all{"--method", method,       "--scheduler",
                                       scheduler,  "--spectral", "4"};
    const auto with = [&](std::vector<std::string> options) {
        options.insert(options.end(), all.begin(), all.end());
        return options;
    };
    INFO(method << ", " << scheduler);
    runs.run("whole", with({"--phases", phases, "--threads", "2"}));
    runs.run("parts", with({"--phases", "3", "--threads", "1"}));
    CHECK(runs.bits("parts") != runs.bits("whole"));
    runs.run("parts", {"--resume", "--phases", "4", "--threads", "3"});
    const Outcome last = runs.run("parts", {"--resume", "--phases", phases, "--threads", "2"});
    CAPTURE(last.err);
    CHECK(last.exit_code == 0);
    CHECK((runs.bits("parts") == runs.bits("whole")));
    // Of a run that is there already, nothing is traced again.
    runs.run("parts", {"--resume", "--phases", "5"});
    CHECK((runs.bits("parts") == runs.bits("whole")));
}

TEST_CASE("A run that was interrupted goes on where it was", "[cli][golden]") {
    const Runs runs;
    const Outcome stopped = run_program_and_interrupt(
        {"run", runs.scene, "-o", runs.path("parts"), "--accuracy", "0.0001%", "--spectral", "4"});
    CHECK(stopped.exit_code == 3);
    CHECK_THAT(stopped.out, Contains("run.state") && Contains("--resume"));
    const int phases = runs.report("parts")["phases"];
    const std::string goal = std::to_string(phases + 3);
    runs.run("parts", {"--resume", "--phases", goal});
    CHECK(runs.report("parts")["phases"] == phases + 3);
    // The plan follows the accuracy that the first part was asked for.
    runs.run("whole", {"--phases", goal, "--accuracy", "0.0001%", "--spectral", "4"});
    CHECK((runs.bits("parts") == runs.bits("whole")));
}

TEST_CASE("Joined runs have the means of all their phases, in any order of their names", "[cli]") {
    const Runs runs;
    runs.run("a", {"--phases", "20", "--seed", "1", "--spectral", "4"});
    runs.run("b", {"--phases", "30", "--seed", "2", "--spectral", "4"});
    runs.run("c", {"--phases", "10", "--seed", "3", "--spectral", "4"});
    const Outcome joined = runs.merge({"a", "b", "c"}, "abc");
    CAPTURE(joined.err);
    REQUIRE(joined.exit_code == 0);
    const json report = runs.report("abc");
    CHECK(report["phases"] == 60);
    CHECK(report["seeds"] == json({1, 2, 3}));
    const auto reading = [&](const std::string& results, std::size_t i) {
        // What was read; the value itself has the luck of the wavelengths of all phases taken off.
        return runs.report(results)["quantities"][i]["uncorrected"]["value"].get<double>();
    };
    for (std::size_t i = 0; i < report["quantities"].size(); ++i) {
        CHECK_THAT(
            reading("abc", i),
            WithinRel((20 * reading("a", i) + 30 * reading("b", i) + 10 * reading("c", i)) / 60,
                      1e-12));
        const json& joined_reading = report["quantities"][i];
        CHECK(std::abs(joined_reading["value"].get<double>() - reading("abc", i)) <=
              std::abs(joined_reading["bias"].get<double>()) +
                  5.0 * joined_reading["uncorrected"]["standard_error"].get<double>());
    }
    CHECK(report["flux_balance_lm"]["closure"].get<double>() < 1e-6);

    runs.merge({"c", "a", "b"}, "cab");
    CHECK((runs.bits("cab") == runs.bits("abc")));
    // A joined run is a run.
    runs.run("d", {"--phases", "2", "--seed", "4", "--spectral", "4"});
    CHECK(runs.merge({"abc", "d"}, "abcd").exit_code == 0);
    CHECK(runs.report("abcd")["phases"] == 62);
}

TEST_CASE("A run that has all of its phases is judged as when it ended", "[cli]") {
    const Runs runs;
    const std::vector<std::string> limits{"--phases", "5", "--accuracy", "90%"};
    std::vector<std::string> again = limits;
    again.emplace_back("--resume");
    REQUIRE(runs.run("a", limits).exit_code == 0);
    const json first = runs.report("a");
    REQUIRE(first["accuracy_reached"] == true);
    REQUIRE(runs.run("a", again).exit_code == 0);
    CHECK(runs.report("a")["accuracy_reached"] == true);
    CHECK(runs.report("a")["stopped_by"] == first["stopped_by"]);
}

TEST_CASE("What cannot be joined or continued is refused before anything is written", "[cli]") {
    const Runs runs;
    runs.run("a", {"--phases", "2"});
    runs.run("same seed", {"--phases", "3"});
    runs.run("path", {"--phases", "2", "--seed", "2", "--method", "path"});
    runs.run("b", {"--phases", "2", "--seed", "3"});
    runs.merge({"a", "b"}, "ab");
    const std::string state = read_text(runs.path("a/run.state"));
    std::filesystem::create_directory(runs.path("damaged"));
    std::string damaged = state;
    damaged[damaged.size() / 2] ^= 1;
    io::write_file(runs.path("damaged/run.state"), damaged);
    std::filesystem::create_directory(runs.path("short"));
    io::write_file(runs.path("short/run.state"), state.substr(0, state.size() / 2));

    const std::vector<std::pair<std::string, std::string>> wrong{
        {"same seed", "seed 1"}, {"ab", "seed 1"},     {"path", "method"},
        {"damaged", "damaged"},  {"short", "damaged"}, {"nowhere", "cannot be read"},
    };
    for (const auto& [other, message] : wrong) {
        const Outcome refused = runs.merge({"a", other}, "joined");
        INFO(message);
        CHECK(refused.exit_code == 2);
        CHECK_THAT(refused.err, Contains(message));
    }
    // All that is wrong at once.
    CHECK_THAT(runs.merge({"a", "damaged", "nowhere"}, "joined").err,
               Contains("damaged/run.state") && Contains("nowhere/run.state"));
    CHECK_FALSE(std::filesystem::exists(runs.path("joined")));

    CHECK_THAT(runs.run("ab", {"--resume", "--phases", "9"}).err, Contains("joins several runs"));
    CHECK(runs.run("fresh", {"--resume", "--phases", "9"}).exit_code == 2);
    CHECK_THAT(runs.run("a", {"--resume", "--seed", "2"}).err, Contains("--seed"));
    io::write_file(runs.scene, ball_on_a_table + "# changed\n");
    CHECK_THAT(runs.run("a", {"--resume", "--phases", "9"}).err, Contains("of another scene"));
    CHECK_THAT(runs.merge({"a", "b"}, "joined").err, Contains("is not the scene of the runs"));
    std::filesystem::remove(runs.scene);
    CHECK_THAT(runs.merge({"a", "b"}, "joined").err, Contains("--scene"));
    CHECK((read_text(runs.path("a/run.state")) == state));
}
