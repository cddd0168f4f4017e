#include <fmt/format.h>

#include <atomic>
#include <csignal>

#include "cli/commands.h"
#include "cli/progress_line.h"
#include "cli/results_folder.h"
#include "core/diagnostics.h"
#include "core/stopwatch.h"
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
    std::signal(SIGTERM, SIG_DFL);
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

// Saves the state now and then, so that hardly any work is lost with the machine: at most every
// minute, and so seldom that it takes 2 % of the time.
class Checkpoints {
public:
    Checkpoints(std::filesystem::path file, io::ReportSource source)
        : file_(std::move(file)), source_(std::move(source)) {}

    void phase_done(const optics::RunState& state) {
        if (since_last_.seconds() < std::max(60.0, 50.0 * last_took_s_)) return;
        save(state);
    }

    void save(const optics::RunState& state) {
        const Stopwatch watch;
        io::write_state(file_, state, source_);
        last_took_s_ = watch.seconds();
        since_last_ = {};
    }

private:
    std::filesystem::path file_;
    io::ReportSource source_;
    Stopwatch since_last_;
    double last_took_s_ = 0.0;
};

optics::RunState saved_state(const std::filesystem::path& path, const io::SceneFile& scene,
                             const std::string& scene_hash) {
    const io::StateFile file(path);
    if (file.source().scene_hash != scene_hash) {
        throw InputError({path.string()},
                         "is of another scene: the scene file or one that it refers to was changed "
                         "since; change limits with --accuracy, --time and --phases instead");
    }
    optics::RunState state = file.state(scene.parts);
    if (state.seeds.size() > 1) {
        throw InputError({path.string()},
                         "joins several runs; go on with one of them and merge again");
    }
    return state;
}

// Simulates the scene once more for each uncertain input, shifted by its uncertainty: by the same
// seed and as many phases, so that the change is not that of the noise.
void look_into_inputs(const RunOptions& options, const io::SceneFile& scene,
                      const optics::RunState& state, optics::Result& result) {
    optics::Settings limits;  // no accuracy and no time: they would end it at another phase
    limits.max_phases = state.phases;
    limits.threads = state.settings.threads;
    for (std::size_t i = 0; i < scene.uncertain_inputs.size() && !interrupted; ++i) {
        const io::UncertainInput& input = scene.uncertain_inputs[i];
        fmt::print(stderr, "input {} of {}, {}\n", i + 1, scene.uncertain_inputs.size(),
                   text_of(input));
        const io::SceneFile shifted = io::read_scene_file(options.scene, input.path);
        ProgressLine line;
        optics::RunState changed(shifted.parts, state.settings);
        optics::go_on(
            shifted.parts, limits, changed,
            {.on_progress = [&](const optics::Progress& progress) { line.show(progress); },
             .on_phase = {},
             .interrupted = &interrupted});
        if (changed.phases == state.phases) {
            optics::add_input_change(result, text_of(input), changed.result(shifted.parts));
        }
    }
    if (result.uncertain_inputs.size() < scene.uncertain_inputs.size()) {
        result.warnings.emplace_back(
            fmt::format("interrupted before all inputs with an uncertainty were looked into: {} of "
                        "{} are part of the result",
                        result.uncertain_inputs.size(), scene.uncertain_inputs.size()));
    }
}

}  // namespace

ExitCode run(const RunOptions& options) {
    const io::SceneFile scene = io::read_scene_file(options.scene);
    const ResultsFolder folder(options.output.value_or(default_results_folder(options.scene)));
    const std::string scene_hash = io::content_hash(scene.files);
    const optics::Settings settings = merged(scene.settings, options);
    optics::RunState state = options.resume ? saved_state(folder.state_file(), scene, scene_hash)
                                            : optics::begin(scene.parts, settings);

    Checkpoints checkpoints(folder.state_file(),
                            {std::filesystem::absolute(options.scene).string(), scene_hash});
    std::signal(SIGINT, interrupt);
    std::signal(SIGTERM, interrupt);
    {
        ProgressLine line;
        optics::go_on(
            scene.parts, settings, state,
            {.on_progress = [&](const optics::Progress& progress) { line.show(progress); },
             .on_phase = [&](const optics::RunState& now) { checkpoints.phase_done(now); },
             .interrupted = &interrupted});
    }
    checkpoints.save(state);
    optics::Result result = state.result(scene.parts);
    look_into_inputs(options, scene, state, result);
    std::signal(SIGINT, SIG_DFL);
    std::signal(SIGTERM, SIG_DFL);
    result.warnings.insert(result.warnings.begin(), scene.warnings.begin(), scene.warnings.end());

    auto files = folder.write(result, {options.scene.string(), scene_hash});
    files.push_back({folder.state_file(), "to go on with --resume, or for lucerna merge"});
    fmt::print("{}", io::summary(result, files));
    return result.accuracy_reached ? done : accuracy_not_reached;
}

}  // namespace lucerna::cli
