// The command bench: how much of the bare ray caster's speed the traces keep.
#include <fmt/format.h>

#include "cli/commands.h"
#include "io/scene_file.h"
#include "optics/transport/benchmark.h"

namespace lucerna::cli {

ExitCode bench(const std::filesystem::path& scene, std::uint32_t paths) {
    const io::SceneFile file = io::read_scene_file(scene);
    const optics::TraceRates rates = measure_trace_rates(file.parts, file.settings, paths);
    fmt::print(
        "One thread, millions of rays per second; the bare cast finds the nearest hit of the "
        "same rays\n{:<10} {:>10} {:>10} {:>10} {:>10}\n",
        "trace", "rays", "traced", "bare", "fraction");
    const auto line = [](const char* name, const optics::TraceRate& rate) {
        fmt::print("{:<10} {:>10} {:>10.2f} {:>10.2f} {:>9.0f} %\n", name, rate.rays,
                   rate.traced_per_s / 1e6, rate.raw_per_s / 1e6, 100.0 * rate.fraction());
    };
    line("forward", rates.forward);
    line("backward", rates.backward);
    return done;
}

}  // namespace lucerna::cli
