#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <csignal>

#include "cli/commands.h"
#include "cli/progress_line.h"
#include "cli/results_folder.h"
#include "core/diagnostics.h"
#include "io/content_hash.h"
#include "io/scene_file.h"
#include "io/summary.h"
#include "optics/transport/simulate.h"

namespace lucerna::cli {
namespace {

std::atomic<bool> interrupted = false;
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may set it");

extern "C" void interrupt(int) {
    interrupted = true;
    std::signal(SIGINT, SIG_DFL);  // a second one ends the program at once
}

optics::Settings merged(optics::Settings settings, const RunOptions& options) {
    if (options.accuracy) settings.image_accuracy = settings.sensor_accuracy = options.accuracy;
    if (options.time_limit_s) settings.time_limit_s = options.time_limit_s;
    if (options.phases) settings.max_phases = options.phases;
    if (options.threads) settings.threads = *options.threads;
    if (options.seed) settings.seed = *options.seed;
    if (options.method) settings.method = *options.method;
    if (options.scheduler) settings.scheduler = *options.scheduler;
    if (options.spectral_bins) settings.spectral_bins = *options.spectral_bins;
    return settings;
}

}  // namespace

ExitCode run(const RunOptions& options) {
    const io::SceneFile scene = io::read_scene_file(options.scene);
    const ResultsFolder folder(options.output.value_or(default_results_folder(options.scene)));
    const std::string scene_hash = io::content_hash(scene.files);

    optics::Result result;
    {
        ProgressLine line;
        std::signal(SIGINT, interrupt);
        result = optics::simulate(
            scene.parts, merged(scene.settings, options),
            [&](const optics::Progress& progress) { line.show(progress); }, &interrupted);
        std::signal(SIGINT, SIG_DFL);
    }
    result.warnings.insert(result.warnings.begin(), scene.warnings.begin(), scene.warnings.end());

    const auto files = folder.write(result, {options.scene.string(), scene_hash});
    fmt::print("{}", io::summary(result, files));
    return result.accuracy_reached ? done : accuracy_not_reached;
}

}  // namespace lucerna::cli
