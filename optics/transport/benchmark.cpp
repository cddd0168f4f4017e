#include "optics/transport/benchmark.h"

#include <chrono>
#include <functional>

#include "optics/transport/backward_trace.h"

namespace lucerna::optics {
namespace {

constexpr int repetitions = 7;

double seconds(const std::function<void()>& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// `trace` is run once to take down its rays; then trace and bare casts alternate, so that both meet
// the same disturbances of the machine.
TraceRate rate(Phase& phase, const std::function<void()>& trace) {
    std::vector<Ray> rays;
    phase.ray_log = &rays;
    trace();
    phase.ray_log = nullptr;
    double best_trace_s = infinity;
    double best_raw_s = infinity;
    for (int i = 0; i < repetitions; ++i) {
        best_trace_s = std::min(best_trace_s, seconds(trace));
        best_raw_s =
            std::min(best_raw_s, seconds([&] { phase.stage.caster().raw_intersect(rays); }));
    }
    const auto count = static_cast<double>(rays.size());
    return {rays.size(), count / best_trace_s, count / best_raw_s};
}

}  // namespace

TraceRates measure_trace_rates(const SceneParts& parts, const Settings& settings,
                               std::uint32_t max_paths) {
    const Stage stage(parts);
    const SensorPlanes planes(parts, stage.caster(), stage.caster().scene_radius_m() / 6.0);
    Phase phase(stage, settings.seed, 0);
    TraceRates rates;
    rates.forward = rate(phase, [&] {
        ForwardTally tally(stage.parts());
        for (std::uint32_t i = 0; i < max_paths; ++i) {
            trace_forward(phase, RandomPurpose::secondary, i, Reach::whole_path, nullptr, tally,
                          [](const Photon&) {});
        }
    });
    const Readings readings(parts, settings);
    PhaseReadings values = readings.new_phase();
    const Collection combined = Collection::of(Method::combined, PlantedError::none);
    const ForwardMaps no_maps;
    rates.backward = rate(phase, [&] {
        BackwardTally tally;
        std::uint64_t paths = 0;
        for (const BinBlock& block : readings.blocks()) {
            if (paths >= max_paths) break;
            const ObserverBins& bins = readings.observers()[block.observer_bins];
            trace_backward(phase, {combined, combined}, bins, block, planes, no_maps, values,
                           tally);
            paths += (block.last - block.first) * bins.samples_per_bin;
        }
    });
    return rates;
}

}  // namespace lucerna::optics
