// The commands of the program: each reads, works, prints, and returns the exit code.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "optics/transport/settings.h"

namespace lucerna::cli {

/// What the program tells the shell.
enum ExitCode {
    done = 0,
    internal_error = 1,
    validation_failed = 1,
    bad_input = 2,
    accuracy_not_reached = 3
};

/// What the command line says about a run; what it leaves open is as the scene file says.
struct RunOptions {
    std::filesystem::path scene;
    std::optional<std::filesystem::path> output;  ///< default: SCENE-results beside the scene
    std::optional<double> accuracy;               ///< of images and sensors, such as 0.02
    std::optional<double> time_limit_s;
    std::optional<std::uint32_t> phases;
    std::optional<int> threads;
    std::optional<std::uint64_t> seed;
    std::optional<optics::Method> method;
    std::optional<optics::Scheduler> scheduler;
    std::optional<int> spectral_bins;
    bool resume = false;  ///< go on from the state in the folder
};

/// Simulates a scene and writes images, previews, report and state; the state also now and then in
/// between. Interrupted by SIGINT or SIGTERM, it finishes the phase and writes.
ExitCode run(const RunOptions& options);

struct MergeOptions {
    std::vector<std::filesystem::path> results;  ///< folders of results with a state
    std::filesystem::path output;
    std::optional<std::filesystem::path> scene;  ///< default: where the runs found it
};
/// Joins runs of one scene with different seeds into one result.
ExitCode merge(const MergeOptions& options);

/// Reads a scene with all checks of a run and says what it holds.
ExitCode check(const std::filesystem::path& scene);

struct CompareOptions {
    std::filesystem::path reference, image;
    std::optional<std::filesystem::path> mask;
    double scale = 1.0;  ///< luminance of the image that stands for 1 in the reference
};
ExitCode compare(const CompareOptions& options);

struct BenchOptions {
    std::vector<std::filesystem::path> scenes;
    std::optional<std::filesystem::path> output;  ///< JSON file
    std::uint32_t paths = 100000;                 ///< of each kind, for the rates of the parts
    int repetitions = 3;
    std::optional<std::uint32_t> phases;  ///< of each run; default: 4, without limit with delta
    std::optional<double> delta;          ///< noise of images to stop each run at, such as 0.05
    std::optional<double> time_limit_s;   ///< of each run until delta; default: 60 s
    std::vector<int> threads;             ///< of the runs; none: all of the machine
    std::vector<optics::Method> methods;  ///< of the runs; none: that of the scene
    std::vector<optics::Scheduler> schedulers;  ///< of the runs; none: that of the scene
};
/// Measures how fast the parts of the engine and whole runs of scenes are.
ExitCode bench(const BenchOptions& options);

struct ValidateOptions {
    std::vector<std::string> cases;     ///< ids, families or patterns; none: all
    bool list = false;                  ///< only say which there are
    std::optional<std::uint32_t> draw;  ///< cases per family, in place of the fixed ones
    std::size_t seeds = 1;
    std::uint64_t seed = 1;
    std::optional<int> threads;
    std::optional<double> accuracy;        ///< to stop each run at, in place of a fixed effort
    std::optional<std::uint32_t> phases;   ///< of each run; with an accuracy, the most of them
    std::optional<optics::Method> method;  ///< in place of the case's own
    std::optional<std::filesystem::path> output;  ///< folder of validation.json and .html
};
/// Runs validation cases and compares them with their truths.
ExitCode validate(const ValidateOptions& options);

/// Says what a photometric file holds.
ExitCode photometry(const std::filesystem::path& file);

}  // namespace lucerna::cli
