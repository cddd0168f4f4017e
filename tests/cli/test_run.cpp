// Runs of the scene that the README starts with.
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

// The YAML block of the README.
std::string readme_scene() {
    const std::string text = io::read_text(LUCERNA_README);
    const std::string start = "```yaml\n";
    const auto from = text.find(start) + start.size();
    return text.substr(from, text.find("```", from) - from);
}

// The same with another text in it.
std::string with(std::string scene, const std::string& old_text, const std::string& new_text) {
    const auto at = scene.find(old_text);
    REQUIRE(at != std::string::npos);
    return scene.replace(at, old_text.size(), new_text);
}

const std::string small = "resolution: [32, 24]";

std::string small_scene() {
    return with(readme_scene(), "resolution: [640, 480]", small);
}

}  // namespace

TEST_CASE("The scene of the README gives the illuminance that it promises", "[cli][analytic]") {
    ScratchFolder folder;
    io::write_file(folder / "table.yaml", small_scene());
    const Outcome outcome = run_program({"run", folder / "table.yaml", "--phases", "64"});
    CAPTURE(outcome.err);
    REQUIRE((outcome.exit_code == 0 || outcome.exit_code == 3));
    const json report = json::parse(io::read_text(folder / "table-results/report.json"));
    const json& reading = report["quantities"].at(0);
    CHECK(reading["name"] == "below the lamp");
    CHECK(reading["quantity"] == "illuminance");
    // E = flux / (pi (h^2 + a^2)) of a Lambertian disk on its axis. Table and panel add at most
    // rho_t rho_p E times the two form factors, 0.35 * 0.8 * (0.2 at most) * 0.0142 * 141 lx = 0.11
    // lx.
    const double direct_lx = 1000.0 / (3.141592653589793 * (1.499 * 1.499 + 0.1 * 0.1));
    const double standard_error_lx = reading["standard_error"];
    CHECK(standard_error_lx < 0.01 * direct_lx);
    CHECK(std::abs(reading["value"].get<double>() - direct_lx - 0.055) <
          4.89 * standard_error_lx + 0.055);
    CHECK_THAT(report["scene_hash"].get<std::string>(), Catch::Matches("[0-9a-f]{64}"));
}

TEST_CASE("A run leaves its files and says so", "[cli]") {
    ScratchFolder folder;
    io::write_file(folder / "table.yaml", small_scene());
    const Outcome outcome = run_program(
        {"run", folder / "table.yaml", "-o", folder / "a/b", "--phases", "2", "--spectral", "5"});
    for (const char* name :
         {"view.exr", "view.spectral.exr", "view.png", "view.false_colour.png", "report.json"}) {
        CHECK(std::filesystem::file_size(folder / "a/b" / name) > 100);
        CHECK_THAT(outcome.out, Contains(name));
    }
    const Outcome compared =
        run_program({"compare", folder / "a/b/view.exr", folder / "a/b/view.exr"});
    CHECK(compared.exit_code == 0);
    CHECK_THAT(compared.out, Contains("ratio of means") && Contains("1.00000"));
}

TEST_CASE("The exit code says whether the accuracy was reached", "[cli]") {
    ScratchFolder folder;
    io::write_file(folder / "table.yaml", small_scene());
    const Outcome hopeless =
        run_program({"run", folder / "table.yaml", "--phases", "2", "--accuracy", "0.0001%"});
    CHECK(hopeless.exit_code == 3);
    CHECK(json::parse(io::read_text(folder / "table-results/report.json"))["accuracy_reached"] ==
          false);
    const Outcome easy =
        run_program({"run", folder / "table.yaml", "--phases", "64", "--accuracy", "90%"});
    CHECK(easy.exit_code == 0);
    CHECK(json::parse(io::read_text(folder / "table-results/report.json"))["stopped_by"] ==
          "accuracy");
}

TEST_CASE("Options of the command line override the file", "[cli]") {
    ScratchFolder folder;
    io::write_file(folder / "table.yaml", small_scene());
    const Outcome outcome =
        run_program({"run", folder / "table.yaml", "--phases", "2", "--seed",
                     "18446744073709551615", "--threads", "1", "--method", "path"});
    REQUIRE((outcome.exit_code == 0 || outcome.exit_code == 3));
    const json report = json::parse(io::read_text(folder / "table-results/report.json"));
    CHECK(report["seed"] == 18446744073709551615ULL);
    CHECK(report["threads"] == 1);
    CHECK(report["method"] == "path");
    CHECK(report["phases"] == 2);
}

TEST_CASE("The images of a seed are the same bytes for any number of threads", "[cli]") {
    ScratchFolder folder;
    io::write_file(folder / "table.yaml", small_scene());
    const auto image = [&](const std::string& seed, const std::string& threads) {
        const std::string results = folder / ("results-" + seed + "-" + threads);
        run_program({"run", folder / "table.yaml", "-o", results, "--phases", "3", "--seed", seed,
                     "--threads", threads});
        return io::read_text(results + "/view.exr");
    };
    const std::string one = image("5", "1");
    CHECK(one.size() > 1000);
    CHECK((one == image("5", "3")));
    CHECK((one != image("6", "1")));
}

TEST_CASE("Ctrl-C finishes the phase and writes what there is", "[cli]") {
    ScratchFolder folder;
    io::write_file(folder / "table.yaml", small_scene());
    const Outcome outcome = run_program_and_interrupt(
        {"run", folder / "table.yaml", "--accuracy", "0.0001%", "--time", "120s"});
    CHECK(outcome.exit_code == 3);
    const json report = json::parse(io::read_text(folder / "table-results/report.json"));
    CHECK(report["stopped_by"] == "interruption");
    CHECK(report["phases"].get<int>() >= 1);
    CHECK(report["wall_s"].get<double>() < 60.0);
}

TEST_CASE("A folder that cannot be made is refused before the run", "[cli]") {
    ScratchFolder folder;
    io::write_file(folder / "table.yaml", small_scene());
    io::write_file(folder / "file", "");
    const Outcome outcome =
        run_program({"run", folder / "table.yaml", "-o", folder / "file/results"});
    CHECK(outcome.exit_code == 2);
    CHECK_THAT(outcome.err, Contains("file/results"));
}
