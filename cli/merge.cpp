#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "cli/commands.h"
#include "cli/results_folder.h"
#include "core/diagnostics.h"
#include "io/content_hash.h"
#include "io/scene_file.h"
#include "io/summary.h"

namespace lucerna::cli {
namespace {

// What makes phases of two runs phases of one simulation; the seed and what only bounds the effort
// may differ.
std::string difference(const optics::Settings& a, const optics::Settings& b) {
    std::string text;
    const auto compare = [&](const char* name, const auto& one, const auto& other) {
        if (one != other) text += (text.empty() ? "" : ", ") + std::string(name);
    };
    compare("method", a.method, b.method);
    compare("bins of the spectral image", a.spectral_bins, b.spectral_bins);
    compare("polarisation", a.polarisation, b.polarisation);
    compare("forward rays", a.forward_rays, b.forward_rays);
    compare("rays per pixel", a.samples_per_pixel, b.samples_per_pixel);
    return text;
}

std::vector<io::StateFile> read_states(const std::vector<std::filesystem::path>& folders) {
    std::vector<io::StateFile> files;
    Diagnostics diagnostics;
    for (const auto& folder : folders) {
        try {
            files.emplace_back(folder / io::state_file_name);
        } catch (const InputError& error) {
            diagnostics.add(error);
            continue;
        }
        const io::StateFile& first = files.front();
        const io::StateFile& last = files.back();
        const auto reject = [&](const std::string& why) {
            diagnostics.add({last.path().string()}, why);
        };
        if (last.source().scene_hash != first.source().scene_hash) {
            reject(fmt::format("is of another scene than {}", first.path().string()));
        } else if (const auto what = difference(first.settings(), last.settings()); !what.empty()) {
            reject(fmt::format("differs from {} in: {}", first.path().string(), what));
        }
    }
    diagnostics.throw_if_any();
    return files;
}

void reject_common_seeds(const std::vector<io::StateFile>& files,
                         const std::vector<optics::RunState>& states) {
    Diagnostics diagnostics;
    std::set<std::uint64_t> known;
    for (std::size_t i = 0; i < states.size(); ++i) {
        for (const std::uint64_t seed : states[i].seeds) {
            if (known.insert(seed).second) continue;
            diagnostics.add({files[i].path().string()},
                            fmt::format("has seed {} like a run before it: the same phases would "
                                        "count twice; give each run a --seed of its own",
                                        seed));
        }
    }
    diagnostics.throw_if_any();
}

}  // namespace

ExitCode merge(const MergeOptions& options) {
    const std::vector<io::StateFile> files = read_states(options.results);
    const io::ReportSource known = files.front().source();
    const std::filesystem::path scene_path = options.scene.value_or(known.scene);
    if (!options.scene && !std::filesystem::exists(scene_path)) {
        throw InputError({scene_path.string()},
                         "the scene of the runs is not there any more; say where with --scene");
    }
    const io::SceneFile scene = io::read_scene_file(scene_path);
    if (io::content_hash(scene.files) != known.scene_hash) {
        throw InputError({scene_path.string()},
                         "is not the scene of the runs, or a file that it refers to was changed");
    }
    std::vector<optics::RunState> states;
    for (const io::StateFile& file : files) states.push_back(file.state(scene.parts));
    reject_common_seeds(files, states);

    // Whoever names them in another order gets the same bits.
    std::sort(states.begin(), states.end(),
              [](const auto& a, const auto& b) { return a.seeds < b.seeds; });
    optics::RunState joined = std::move(states.front());
    for (std::size_t i = 1; i < states.size(); ++i) joined.merge(states[i]);
    joined.stopped_by = "merge";
    joined.accuracy_reached = true;

    const ResultsFolder folder(options.output);
    const io::ReportSource source{scene_path.string(), known.scene_hash};
    io::write_state(folder.state_file(), joined, source);
    optics::Result result = joined.result(scene.parts);
    result.warnings.insert(result.warnings.begin(), scene.warnings.begin(), scene.warnings.end());
    if (!scene.uncertain_inputs.empty()) {
        result.warnings.emplace_back(
            "the uncertainties that the scene states for inputs are not part of a joined result");
    }
    auto written = folder.write(result, source);
    written.push_back({folder.state_file(), "for lucerna merge"});
    fmt::print("{}", io::summary(result, written));
    return done;
}

}  // namespace lucerna::cli
