#include "optics/transport/run_state.h"

#include <algorithm>

#include "core/stopwatch.h"

namespace lucerna::optics {
namespace {

FluxBalance balance(const SceneParts& parts, const ForwardTally& tally, std::uint64_t rays) {
    const double scale = 1.0 / static_cast<double>(std::max<std::uint64_t>(1, rays));
    FluxBalance balance;
    balance.emitted = tally.emitted * scale;
    balance.escaped = tally.escaped * scale;
    balance.trapped = tally.trapped * scale;
    balance.inconsistent_medium = tally.inconsistent * scale;
    balance.numerical = tally.numerical * scale;
    balance.roulette_residue = tally.residue * scale;
    for (std::size_t i = 0; i < parts.objects.size(); ++i) {
        const Object& object = parts.objects[i];
        if (tally.absorbed_by_object[i] != 0.0) {
            balance.absorbed[object.material] += tally.absorbed_by_object[i] * scale;
        }
        if (object.interior && tally.absorbed_by_solid[i] != 0.0) {
            balance.absorbed["inside " + parts.media[*object.interior].name] +=
                tally.absorbed_by_solid[i] * scale;
        }
    }
    return balance;
}

void warn_of_losses(Result& result) {
    const FluxBalance& flux = result.flux_balance_lm;
    if (flux.inconsistent_medium > 1e-6 * flux.emitted) {
        result.warnings.emplace_back(
            "light was lost where transparent solids contradict each other: check for solids "
            "that share a face or are not closed");
    }
    if (flux.numerical > 0.0) result.warnings.emplace_back("light was lost to undefined numbers");
}

// Both sides of each receiver, one after the other.
std::string side_name(const FluxReceiver& receiver, std::size_t side) {
    return receiver.name + (side % 2 == 0 ? " (front)" : " (back)");
}

}  // namespace

RunState::RunState(const SceneParts& parts, const Settings& of_run)
    : settings(of_run),
      seeds{of_run.seed},
      readings(parts, of_run),
      tally(parts),
      received(2 * parts.receivers.size()) {}

void RunState::fold(const SceneParts& parts, const Phase& phase, PhaseTrace& trace, int threads,
                    int lanes) {
    const Stopwatch watch;
    readings.fold(phase, trace.readings, threads);
    if (++phases > 1) delta = readings.delta(threads);
    counts.readings_s += watch.seconds();
    const auto rays = static_cast<double>(trace.balance_rays);
    for (std::size_t i = 0; i < parts.receivers.size(); ++i) {
        const ObjectId object = parts.receivers[i].object;
        received[2 * i].add(trace.tally.received_front[object] / rays);
        received[2 * i + 1].add(trace.tally.received_back[object] / rays);
    }
    tally += trace.tally;
    tally_rays += trace.balance_rays;
    trace.tally = ForwardTally(parts);
    counts += trace.counts;
    trace.counts = {};
    const auto maps = static_cast<std::uint64_t>(lanes);
    forward_map_bytes = std::max(forward_map_bytes, maps * trace.forward_map_bytes);
    backward_map_bytes = std::max(backward_map_bytes, maps * trace.backward_map_bytes);
}

void RunState::merge(const RunState& other) {
    seeds.insert(seeds.end(), other.seeds.begin(), other.seeds.end());
    phases += other.phases;
    wall_s += other.wall_s;
    for (const std::string& warning : other.warnings) {
        if (std::find(warnings.begin(), warnings.end(), warning) == warnings.end()) {
            warnings.push_back(warning);
        }
    }
    readings.merge(other.readings);
    tally += other.tally;
    tally_rays += other.tally_rays;
    for (std::size_t i = 0; i < received.size(); ++i) received[i].merge(other.received[i]);
    counts += other.counts;
    forward_map_bytes = std::max(forward_map_bytes, other.forward_map_bytes);
    backward_map_bytes = std::max(backward_map_bytes, other.backward_map_bytes);
}

Furthest RunState::furthest_receiver(const SceneParts& parts, const Settings& targets) const {
    Furthest furthest;
    for (std::size_t i = 0; i < parts.receivers.size(); ++i) {
        const SensorTarget target = targets.target_of(parts.receivers[i].name);
        // Relative to both sides together: hardly any light on one is no reason to go on.
        const double value = received[2 * i].value() + received[2 * i + 1].value();
        for (std::size_t side = 2 * i; side < 2 * i + 2; ++side) {
            const double excess =
                target.excess(value, received[side].expanded_uncertainty(target_coverage));
            if (excess > furthest.excess) furthest = {side_name(parts.receivers[i], side), excess};
        }
    }
    return furthest;
}

Result RunState::result(const SceneParts& parts) const {
    Result result;
    result.images = readings.images(parts, settings.threads);
    result.quantities = readings.quantities(parts);
    for (std::size_t i = 0; i < parts.receivers.size(); ++i) {
        for (std::size_t side = 2 * i; side < 2 * i + 2; ++side) {
            result.quantities.push_back(
                {side_name(parts.receivers[i], side), "luminous flux", "lm", received[side]});
        }
    }
    result.derived = readings.derived(parts);
    result.flux_balance_lm = balance(parts, tally, tally_rays);
    result.rays = counts;
    result.forward_map_bytes = forward_map_bytes;
    result.backward_map_bytes = backward_map_bytes;
    result.image_bytes = readings.bytes();
    result.settings = settings;
    result.seeds = seeds;
    result.phases = phases;
    result.wall_s = wall_s;
    result.stopped_by = stopped_by;
    result.accuracy_reached = accuracy_reached;
    result.furthest = furthest;
    warn_of_losses(result);
    result.warnings.insert(result.warnings.end(), warnings.begin(), warnings.end());
    return result;
}

}  // namespace lucerna::optics
