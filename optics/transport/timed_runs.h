// Whole simulations side by side: time and memory of several methods, schedulers and numbers of
// threads.
#pragma once

#include "optics/scene.h"
#include "optics/transport/result.h"
#include "optics/transport/settings.h"

namespace lucerna::optics {

/// Time, memory and noise of a simulation.
struct RunMeasure {
    double wall_s = 0.0;
    double cpu_s = 0.0;  ///< of all threads
    std::uint32_t phases = 0;
    RayCounts rays;  ///< work and time by stage, over all phases
    /// Noise of the worst image; infinite after one phase, not a number without images.
    double delta = 0.0;
    std::string stopped_by;         ///< as in Result
    bool accuracy_reached = false;  ///< false too if none was asked for
    std::uint64_t forward_map_bytes = 0, backward_map_bytes = 0, image_bytes = 0;  ///< largest seen
    std::uint64_t peak_memory_bytes = 0;  ///< of the process during the run

    /// Wall time without setup and pilot phases, over the number of phases [s].
    double phase_s() const;
    /// Part of the wall time of all phases that no stage counts [s].
    double rest_s() const;
    /// Wall time until the noise is `delta_wanted`, if it falls with the square root of the number
    /// of phases [s].
    double expected_s(double delta_wanted) const;
};

/// The same simulation several times.
struct TimedRun {
    Method method;
    Scheduler scheduler;
    int threads;
    std::vector<RunMeasure> repetitions;
    /// The repetition with the least wall time per phase.
    const RunMeasure& fastest() const;
};

/// What to run, and when each run stops: at the first of the limits that are given.
struct RunPlan {
    std::vector<Method> methods;
    std::vector<Scheduler> schedulers;
    std::vector<int> threads;
    int repetitions = 3;
    std::optional<std::uint32_t> phases;
    std::optional<double> delta;  ///< noise of images, such as 0.05
    std::optional<double> time_limit_s;
};

/// Runs each method with each scheduler and each number of threads, in this order. All of them take
/// turns, in every other repetition backwards, so that they meet the same disturbances of the
/// machine. What the settings ask of accuracy and time gives way to the plan. Throws InputError if
/// a part of the scene is inconsistent.
std::vector<TimedRun> time_runs(const SceneParts& parts, const Settings& settings,
                                const RunPlan& plan);

/// A run against another: the medians over repetitions of what was measured next to each other.
struct Comparison {
    double speed_up;  ///< in time per phase
    double
        speed_up_equal_noise;  ///< in time per phase times delta squared; not a number if unknown
    double map_and_image_memory;  ///< ratio of bytes
    double peak_memory;           ///< the same of the process
};
Comparison compare(const TimedRun& run, const TimedRun& first);

}  // namespace lucerna::optics
