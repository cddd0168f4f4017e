#include "optics/transport/timed_runs.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <functional>

#include "core/process_memory.h"
#include "optics/transport/simulate.h"

namespace lucerna::optics {
namespace {

double median(std::vector<double> values) {
    if (!std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); })) {
        return std::nan("");
    }
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    if (values.size() % 2 == 1) return *middle;
    return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

RunMeasure measure_run(const SceneParts& parts, const Settings& settings) {
    restart_peak_memory();
    const std::clock_t cpu_start = std::clock();
    const Result result = simulate(parts, settings);
    RunMeasure measure;
    measure.cpu_s = static_cast<double>(std::clock() - cpu_start) / CLOCKS_PER_SEC;
    measure.peak_memory_bytes = peak_memory_bytes();
    measure.wall_s = result.wall_s;
    measure.phases = result.phases;
    measure.rays = result.rays;
    if (settings.scheduler == Scheduler::asynchronous) {
        // Phases that are traced at the same time share the wall time.
        RayCounts& rays = measure.rays;
        for (double* stage_s : {&rays.caustic_s, &rays.maps_s, &rays.backward_s, &rays.secondary_s,
                                &rays.readings_s}) {
            *stage_s /= result.settings.threads;
        }
    }
    if (result.images.empty()) measure.delta = std::nan("");
    for (const Image& image : result.images) measure.delta = std::max(measure.delta, image.delta);
    measure.stopped_by = result.stopped_by;
    measure.accuracy_reached = settings.image_accuracy && result.accuracy_reached;
    measure.forward_map_bytes = result.forward_map_bytes;
    measure.backward_map_bytes = result.backward_map_bytes;
    measure.image_bytes = result.image_bytes;
    return measure;
}

}  // namespace

double RunMeasure::phase_s() const {
    return (wall_s - rays.setup_s - rays.pilot_s) / phases;
}

double RunMeasure::rest_s() const {
    return wall_s - rays.setup_s - rays.pilot_s - rays.caustic_s - rays.maps_s - rays.backward_s -
           rays.secondary_s - rays.readings_s;
}

double RunMeasure::expected_s(double delta_wanted) const {
    const double phases_wanted = phases * std::pow(delta / delta_wanted, 2);
    return rays.setup_s + rays.pilot_s + phase_s() * phases_wanted;
}

const RunMeasure& TimedRun::fastest() const {
    return *std::min_element(
        repetitions.begin(), repetitions.end(),
        [](const RunMeasure& a, const RunMeasure& b) { return a.phase_s() < b.phase_s(); });
}

std::vector<TimedRun> time_runs(const SceneParts& parts, const Settings& settings,
                                const RunPlan& plan) {
    std::vector<TimedRun> runs;
    for (const Method method : plan.methods) {
        for (const Scheduler scheduler : plan.schedulers) {
            for (const int threads : plan.threads) runs.push_back({method, scheduler, threads, {}});
        }
    }
    for (int repetition = 0; repetition < plan.repetitions; ++repetition) {
        for (std::size_t turn = 0; turn < runs.size(); ++turn) {
            TimedRun& run = runs[repetition % 2 == 0 ? turn : runs.size() - 1 - turn];
            Settings of_run = settings;
            of_run.method = run.method;
            of_run.scheduler = run.scheduler;
            of_run.threads = run.threads;
            of_run.max_phases = plan.phases;
            of_run.image_accuracy = plan.delta;
            of_run.time_limit_s = plan.time_limit_s;
            of_run.sensor_accuracy.reset();
            of_run.sensor_targets.clear();
            run.repetitions.push_back(measure_run(parts, of_run));
        }
    }
    return runs;
}

Comparison compare(const TimedRun& run, const TimedRun& first) {
    const auto ratio = [&](const std::function<double(const RunMeasure&)>& of) {
        std::vector<double> ratios;
        for (std::size_t i = 0; i < run.repetitions.size(); ++i) {
            ratios.push_back(of(run.repetitions[i]) / of(first.repetitions[i]));
        }
        return median(ratios);
    };
    const auto effort = [](const RunMeasure& m) {  // of the image
        return m.phase_s() * m.phases * m.delta * m.delta;
    };
    const auto map_and_image_bytes = [](const RunMeasure& m) {
        return static_cast<double>(m.forward_map_bytes + m.backward_map_bytes + m.image_bytes);
    };
    return {1.0 / ratio(&RunMeasure::phase_s), 1.0 / ratio(effort), ratio(map_and_image_bytes),
            ratio([](const RunMeasure& m) { return static_cast<double>(m.peak_memory_bytes); })};
}

}  // namespace lucerna::optics
