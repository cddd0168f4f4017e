// The command bench: how fast the parts of the engine and whole runs are.
#include <fmt/format.h>

#include "cli/commands.h"
#include "cli/results_folder.h"
#include "core/diagnostics.h"
#include "core/parallel.h"
#include "io/atomic_file.h"
#include "io/benchmark_report.h"
#include "io/content_hash.h"
#include "io/scene_file.h"
#include "optics/transport/stage.h"

namespace lucerna::cli {
namespace {

constexpr std::uint32_t default_phases = 4;
constexpr double default_time_limit_s = 60.0;

io::SceneFile read_checked(const std::filesystem::path& path, const BenchOptions& options) {
    io::SceneFile scene = io::read_scene_file(path);
    const optics::Stage stage(scene.parts);  // throws where parts contradict each other
    const auto is_camera = [](const optics::Observer& observer) {
        return std::holds_alternative<optics::Camera>(observer);
    };
    if (options.delta && std::ranges::none_of(scene.parts.observers, is_camera)) {
        throw InputError({path.string()},
                         "has no camera, and --delta asks for the noise of images");
    }
    return scene;
}

io::BenchmarkPlan plan_of(const BenchOptions& options) {
    io::BenchmarkPlan plan;
    plan.rates.paths = options.paths;
    plan.rates.repetitions = plan.runs.repetitions = options.repetitions;
    plan.rates.threads = plan.runs.threads = options.threads;
    if (options.threads.empty()) {
        plan.rates.threads = {1};
        if (hardware_threads() > 1) plan.rates.threads.push_back(hardware_threads());
        plan.runs.threads = {hardware_threads()};
    }
    plan.runs.phases = options.phases;
    plan.runs.delta = options.delta;
    if (options.delta) {
        plan.runs.time_limit_s = options.time_limit_s.value_or(default_time_limit_s);
    } else {
        plan.runs.phases = options.phases.value_or(default_phases);
    }
    return plan;
}

// Where the file goes is made sure of first, not to find out at the end.
void check_writable(const std::filesystem::path& file) {
    if (std::filesystem::is_directory(file)) {
        throw InputError({file.string()}, "is a folder; -o names the file to write");
    }
    make_folder(file.has_parent_path() ? file.parent_path() : ".");
}

}  // namespace

ExitCode bench(const BenchOptions& options) {
    std::vector<io::SceneFile> scenes;
    for (const auto& path : options.scenes) scenes.push_back(read_checked(path, options));
    if (options.output) check_writable(*options.output);

    const io::BenchmarkPlan plan = plan_of(options);
    std::vector<io::SceneBenchmark> results;
    for (std::size_t i = 0; i < scenes.size(); ++i) {
        const io::SceneFile& scene = scenes[i];
        optics::RunPlan runs = plan.runs;
        runs.methods = options.methods;
        if (runs.methods.empty()) runs.methods = {scene.settings.method};
        runs.schedulers = options.schedulers;
        if (runs.schedulers.empty()) runs.schedulers = {scene.settings.scheduler};
        results.push_back({options.scenes[i].string(), io::content_hash(scene.files),
                           scene.settings.seed,
                           optics::measure_rates(scene.parts, scene.settings, plan.rates),
                           optics::time_runs(scene.parts, scene.settings, runs)});
        fmt::print("{}{}", i > 0 ? "\n" : "", io::benchmark_text(results.back(), plan));
        std::fflush(stdout);  // the next scene may take long
    }
    if (options.output) {
        io::write_file(*options.output, io::benchmark_json(results, plan));
        fmt::print("\nWritten\n  {}\n", options.output->string());
    }
    return done;
}

}  // namespace lucerna::cli
