#include "optics/transport/simulate.h"

#include <condition_variable>
#include <mutex>
#include <thread>

#include "core/parallel.h"
#include "core/stopwatch.h"
#include "optics/transport/accuracy.h"
#include "optics/transport/plan.h"

namespace lucerna::optics {
namespace {

// What all phases of a run have in common.
class Simulation {
public:
    Simulation(const SceneParts& parts, RunState& state, int threads)
        : settings_(state.settings),
          stage_(parts, settings_.polarisation),
          threads_(threads),
          lanes_(settings_.scheduler == Scheduler::asynchronous ? threads_ : 1),
          planes_(stage_.parts(), stage_.caster(), stage_.caster().scene_radius_m() / 6.0),
          context_{stage_, planes_, state.readings, settings_.scheduler, threads_ / lanes_},
          setup_s_(construction_watch_.seconds()),
          plan_(make_plan({stage_, planes_, state.readings, settings_.scheduler, threads_},
                          settings_)) {
        state.counts.setup_s += setup_s_;
        state.counts.pilot_s += construction_watch_.seconds() - setup_s_;
        state.settings.threads = threads_;
        state.settings.polarisation = stage_.follows_polarisation();
    }

    /// Phases that are traced at the same time, and the threads of each.
    int lanes() const { return lanes_; }
    int threads_of_lane() const { return context_.threads; }

    const Stage& stage() const { return stage_; }
    Phase phase(std::uint32_t number) const { return {stage_, settings_.seed, number}; }
    PhaseTrace new_trace() const { return PhaseTrace(context_); }
    void trace(const Phase& phase, PhaseTrace& trace) const {
        trace_phase(phase, context_, plan_, plan_.rays.blocks(), phase.number, trace);
    }

private:
    Stopwatch construction_watch_;
    Settings settings_;
    Stage stage_;
    int threads_, lanes_;
    SensorPlanes planes_;
    TraceContext context_;
    double setup_s_;
    Plan plan_;
};

Settings with_default_target(Settings settings) {
    if (!settings.image_accuracy && !settings.sensor_accuracy && settings.sensor_targets.empty() &&
        !settings.time_limit_s && !settings.max_phases) {
        settings.image_accuracy = 0.02;
        settings.sensor_accuracy = 0.01;
    }
    return settings;
}

Progress progress_of(const RunState& state, const StopRule& rule) {
    const RayCounts& counts = state.counts;
    const double rays = static_cast<double>(counts.backward_segments + counts.forward_segments +
                                            counts.shadow_segments);
    Furthest furthest = rule.furthest(state);
    return {.phase = state.phases,
            .delta = state.delta,
            .delta_wanted = rule.image_accuracy(),
            .rays_per_s = rays / state.wall_s,
            .elapsed_s = state.wall_s,
            .left_s = rule.left_s(state, furthest),
            .furthest = std::move(furthest)};
}

}  // namespace

void RayCounts::operator+=(const RayCounts& other) {
    backward_rays += other.backward_rays;
    caustic_rays += other.caustic_rays;
    secondary_rays += other.secondary_rays;
    backward_segments += other.backward_segments;
    forward_segments += other.forward_segments;
    shadow_segments += other.shadow_segments;
    forward_photons += other.forward_photons;
    backward_photons += other.backward_photons;
    scattering_hits += other.scattering_hits;
    deposits += other.deposits;
    setup_s += other.setup_s;
    pilot_s += other.pilot_s;
    caustic_s += other.caustic_s;
    maps_s += other.maps_s;
    backward_s += other.backward_s;
    secondary_s += other.secondary_s;
    readings_s += other.readings_s;
}

double FluxBalance::closure() const {
    double rest = emitted - escaped - trapped - inconsistent_medium - numerical - roulette_residue;
    for (const auto& [name, flux] : absorbed) rest -= flux;
    return rest;
}

RunState begin(const SceneParts& parts, const Settings& settings) {
    return {parts, with_default_target(settings)};
}

Result simulate(const SceneParts& parts, const Settings& settings, const Watch& watch) {
    RunState state = begin(parts, settings);
    go_on(parts, settings, state, watch);
    return state.result(parts);
}

void go_on(const SceneParts& parts, const Settings& asked, RunState& state, const Watch& watch) {
    const Stopwatch stopwatch;
    const double before_s = state.wall_s;
    Settings limits = with_default_target(asked);
    if (limits.time_limit_s) *limits.time_limit_s += before_s;
    StopRule rule(parts, limits, state.phases);
    state.stopped_by.clear();
    const auto note_accuracy = [&] {
        state.accuracy_reached = rule.accuracy_reached();
        state.furthest = state.accuracy_reached ? Furthest{} : rule.furthest(state);
    };
    const int threads = limits.threads > 0 ? limits.threads : hardware_threads();
    if (state.phases > 1) state.delta = state.readings.delta(threads);  // it may have been loaded
    if (limits.max_phases && state.phases >= *limits.max_phases) {
        state.stopped_by = rule.check(state);
        note_accuracy();
        return;
    }
    Simulation simulation(parts, state, threads);
    if (state.settings.method == Method::path && simulation.stage().has_caustics()) {
        state.warnings = {
            "path tracing does not see light of points and beams behind specular surfaces, and "
            "finds "
            "lamps behind them by chance: what no ray has found yet is in no U"};
    }

    std::mutex mutex;
    std::condition_variable folded;
    std::uint32_t next = state.phases;  // phase to be traced
    // Phases are folded in their order, whichever is traced first: those that are under way when
    // the simulation stops are lost.
    const auto fold_in_order = [&](const Phase& phase, PhaseTrace& trace) {
        std::unique_lock lock(mutex);
        folded.wait(lock,
                    [&] { return state.phases == phase.number || !state.stopped_by.empty(); });
        if (!state.stopped_by.empty()) return;
        state.fold(parts, phase, trace, simulation.threads_of_lane(), simulation.lanes());
        state.wall_s = before_s + stopwatch.seconds();
        state.stopped_by = rule.check(state);
        if (state.stopped_by.empty() && watch.interrupted && watch.interrupted->load()) {
            state.stopped_by = "interruption";
        }
        if (watch.on_progress) watch.on_progress(progress_of(state, rule));
        if (watch.on_phase) watch.on_phase(state);
        folded.notify_all();
    };
    const auto trace_phases = [&] {
        PhaseTrace trace = simulation.new_trace();
        while (true) {
            std::uint32_t number;
            {
                const std::scoped_lock lock(mutex);
                if (!state.stopped_by.empty() || next >= limits.max_phases.value_or(~0u)) return;
                number = next++;
            }
            const Phase phase = simulation.phase(number);
            simulation.trace(phase, trace);
            fold_in_order(phase, trace);
        }
    };
    {
        std::vector<std::jthread> lanes;
        for (int i = 1; i < simulation.lanes(); ++i) lanes.emplace_back(trace_phases);
        trace_phases();
    }
    note_accuracy();
    state.wall_s = before_s + stopwatch.seconds();
}

}  // namespace lucerna::optics
