#include "optics/transport/simulate.h"

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "core/parallel.h"
#include "core/stopwatch.h"
#include "optics/transport/accuracy.h"
#include "optics/transport/plan.h"

namespace lucerna::optics {
namespace {

class Simulation {
public:
    Simulation(const SceneParts& parts, const Settings& settings)
        : settings_(settings),
          stage_(parts, settings.polarisation),
          threads_(settings.threads > 0 ? settings.threads : hardware_threads()),
          lanes_(settings.scheduler == Scheduler::asynchronous ? threads_ : 1),
          planes_(stage_.parts(), stage_.caster(), stage_.caster().scene_radius_m() / 6.0),
          readings_(parts, settings),
          context_{stage_, planes_, readings_, settings.scheduler, threads_},
          setup_s_(construction_watch_.seconds()),
          plan_(make_plan(context_, settings)),
          total_(stage_.parts()),
          received_(2 * parts.receivers.size()) {
        for (const FluxReceiver& receiver : parts.receivers) {
            receiver_targets_.push_back(settings.target_of(receiver.name));
        }
        counts_.setup_s = setup_s_;
        counts_.pilot_s = construction_watch_.seconds() - setup_s_;
    }

    /// Phases that are traced at the same time.
    int lanes() const { return lanes_; }
    Phase phase(std::uint32_t number) const { return {stage_, settings_.seed, number}; }
    PhaseTrace new_trace() const { return PhaseTrace(context_); }

    void trace(const Phase& phase, PhaseTrace& trace) const {
        TraceContext context = context_;
        context.threads = threads_ / lanes_;
        trace_phase(phase, context, plan_, plan_.rays.blocks(), phase.number, trace);
    }

    /// Adds a phase to the estimates and empties its trace.
    void fold(const Phase& phase, PhaseTrace& trace) {
        const Stopwatch watch;
        readings_.fold(phase, trace.readings, threads_ / lanes_);
        counts_.readings_s += watch.seconds();
        fold_tally(trace);
        counts_ += trace.counts;
        trace.counts = {};
        forward_map_bytes_ = std::max(forward_map_bytes_, trace.forward_map_bytes);
        backward_map_bytes_ = std::max(backward_map_bytes_, trace.backward_map_bytes);
        ++phases_;
    }

    /// Largest ratio of the expanded uncertainty of a receiver to what is asked for.
    double worst_receiver() const {
        double worst = 0.0;
        for (std::size_t i = 0; i < stage_.parts().receivers.size(); ++i) {
            const Estimate& front = received_[2 * i];
            const Estimate& back = received_[2 * i + 1];
            const SensorTarget& target = receiver_targets_[i];
            // Relative to both sides together: hardly any light on one is no reason to go on.
            const double value = front.value() + back.value();
            for (const Estimate* side : {&front, &back}) {
                worst = std::max(
                    worst, excess(target, value, side->expanded_uncertainty(target_coverage)));
            }
        }
        return worst;
    }

    Result result() const {
        Result result;
        const SceneParts& parts = stage_.parts();
        result.images = readings_.images(parts);
        result.quantities = readings_.quantities(parts);
        for (std::size_t i = 0; i < parts.receivers.size(); ++i) {
            result.quantities.push_back(
                {parts.receivers[i].name + " (front)", "luminous flux", "lm", received_[2 * i]});
            result.quantities.push_back(
                {parts.receivers[i].name + " (back)", "luminous flux", "lm", received_[2 * i + 1]});
        }
        result.derived = readings_.derived(parts);
        result.flux_balance_lm = balance();
        result.rays = counts_;
        const auto lanes = static_cast<std::uint64_t>(lanes_);
        result.forward_map_bytes = lanes * forward_map_bytes_;
        result.backward_map_bytes = lanes * backward_map_bytes_;
        result.image_bytes = readings_.bytes();
        result.settings = settings_;
        result.settings.forward_rays = plan_.secondary_rays;
        result.settings.threads = threads_;
        result.settings.polarisation = stage_.follows_polarisation();
        result.phases = phases_;
        add_warnings(result);
        return result;
    }

    const Readings& readings() const { return readings_; }
    const RayCounts& counts() const { return counts_; }
    const SceneParts& parts() const { return stage_.parts(); }

private:
    void fold_tally(PhaseTrace& trace) {
        const ForwardTally& tally = trace.tally;
        const auto rays = static_cast<double>(trace.balance_rays);
        for (std::size_t i = 0; i < stage_.parts().receivers.size(); ++i) {
            const ObjectId object = stage_.parts().receivers[i].object;
            received_[2 * i].add(tally.received_front[object] / rays);
            received_[2 * i + 1].add(tally.received_back[object] / rays);
        }
        total_ += tally;
        total_rays_ += trace.balance_rays;
        trace.tally = ForwardTally(stage_.parts());
    }

    FluxBalance balance() const {
        const SceneParts& parts = stage_.parts();
        const double scale = 1.0 / static_cast<double>(std::max<std::uint64_t>(1, total_rays_));
        FluxBalance balance;
        balance.emitted = total_.emitted * scale;
        balance.escaped = total_.escaped * scale;
        balance.trapped = total_.trapped * scale;
        balance.inconsistent_medium = total_.inconsistent * scale;
        balance.numerical = total_.numerical * scale;
        balance.roulette_residue = total_.residue * scale;
        for (std::size_t i = 0; i < parts.objects.size(); ++i) {
            const Object& object = parts.objects[i];
            if (total_.absorbed_by_object[i] != 0.0) {
                balance.absorbed[object.material] += total_.absorbed_by_object[i] * scale;
            }
            if (object.interior && total_.absorbed_by_solid[i] != 0.0) {
                balance.absorbed["inside " + parts.media[*object.interior].name] +=
                    total_.absorbed_by_solid[i] * scale;
            }
        }
        return balance;
    }

    void add_warnings(Result& result) const {
        const FluxBalance& flux = result.flux_balance_lm;
        if (flux.inconsistent_medium > 1e-6 * flux.emitted) {
            result.warnings.emplace_back(
                "light was lost where transparent solids contradict each other: check for solids "
                "that share a face or are not closed");
        }
        if (flux.numerical > 0.0)
            result.warnings.emplace_back("light was lost to undefined numbers");
        if (settings_.method == Method::path && stage_.has_caustics()) {
            result.warnings.emplace_back(
                "path tracing does not see light of points and beams behind specular surfaces");
        }
    }

    Stopwatch construction_watch_;
    Settings settings_;
    Stage stage_;
    int threads_, lanes_;
    SensorPlanes planes_;
    Readings readings_;
    TraceContext context_;
    double setup_s_;
    Plan plan_;
    ForwardTally total_;              // over phases
    std::uint64_t total_rays_ = 0;    // of total_
    std::vector<Estimate> received_;  // per receiver: front, back
    std::vector<SensorTarget> receiver_targets_;
    RayCounts counts_;
    std::uint64_t forward_map_bytes_ = 0, backward_map_bytes_ = 0;
    std::uint32_t phases_ = 0;
};

Settings with_default_target(Settings settings) {
    if (!settings.image_accuracy && !settings.sensor_accuracy && settings.sensor_targets.empty() &&
        !settings.time_limit_s && !settings.max_phases) {
        settings.image_accuracy = 0.02;
        settings.sensor_accuracy = 0.01;
    }
    return settings;
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

Result simulate(const SceneParts& parts, const Settings& asked,
                const std::function<void(const Progress&)>& on_progress,
                const std::atomic<bool>* interrupted) {
    const Stopwatch watch;
    const Settings settings = with_default_target(asked);
    Simulation simulation(parts, settings);
    const auto is_camera = [](const Observer& o) { return std::holds_alternative<Camera>(o); };
    const bool has_cameras = std::any_of(parts.observers.begin(), parts.observers.end(), is_camera);
    const bool has_sensors =
        !parts.receivers.empty() ||
        !std::all_of(parts.observers.begin(), parts.observers.end(), is_camera);
    StopRule rule(settings, has_cameras, has_sensors);

    std::mutex mutex;
    std::condition_variable folded;
    std::uint32_t next = 0;  // phase to be traced
    std::uint32_t done = 0;
    std::string stopped_by;
    // Phases are folded in their order, whichever is traced first: those that are under way when
    // the simulation stops are lost.
    const auto fold_in_order = [&](const Phase& phase, PhaseTrace& trace) {
        std::unique_lock lock(mutex);
        folded.wait(lock, [&] { return done == phase.number || !stopped_by.empty(); });
        if (!stopped_by.empty()) return;
        simulation.fold(phase, trace);
        ++done;
        const double elapsed_s = watch.seconds();
        stopped_by =
            rule.check(done, simulation.readings(), simulation.worst_receiver(), elapsed_s);
        if (stopped_by.empty() && interrupted && interrupted->load()) stopped_by = "interruption";
        if (on_progress) {
            const RayCounts& counts = simulation.counts();
            const double rays = static_cast<double>(
                counts.backward_segments + counts.forward_segments + counts.shadow_segments);
            on_progress({.phase = done,
                         .delta = done > 1 ? simulation.readings().delta() : std::nan(""),
                         .delta_wanted = has_cameras ? settings.image_accuracy : std::nullopt,
                         .rays_per_s = rays / elapsed_s,
                         .elapsed_s = elapsed_s,
                         .left_s = rule.left_s(simulation.readings(), simulation.worst_receiver(),
                                               elapsed_s)});
        }
        folded.notify_all();
    };
    const auto trace_phases = [&] {
        PhaseTrace trace = simulation.new_trace();
        while (true) {
            std::uint32_t number;
            {
                const std::scoped_lock lock(mutex);
                if (!stopped_by.empty() || next >= settings.max_phases.value_or(~0u)) return;
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
    Result result = simulation.result();
    result.stopped_by = stopped_by;
    result.accuracy_reached = rule.accuracy_reached();
    result.wall_s = watch.seconds();
    return result;
}

}  // namespace lucerna::optics
