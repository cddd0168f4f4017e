// The simulation: the loop over phases.
#pragma once

#include <atomic>
#include <functional>

#include "optics/scene.h"
#include "optics/transport/run_state.h"

namespace lucerna::optics {

/// State of a running simulation, for the progress line.
struct Progress {
    std::uint32_t phase = 0;  ///< phases done
    double delta = 0.0;       ///< docs/method.md eq. 6; not a number before two phases
    std::optional<double> delta_wanted;
    double rays_per_s = 0.0;
    double elapsed_s = 0.0;
    std::optional<double> left_s;
    Furthest furthest{};  ///< of all that is asked for
};

/// What may watch over a simulation; all of it is called and looked at after each phase.
struct Watch {
    std::function<void(const Progress&)> on_progress;
    std::function<void(const RunState&)> on_phase;
    const std::atomic<bool>* interrupted = nullptr;  ///< ends the simulation when it turns true
};

/// Simulates until the accuracy asked for, the time limit or the number of phases is reached;
/// without any of them until the images have delta = 2 % and the sensors a standard error of 1 %.
/// Same scene, settings and seed give the same bits for any number of threads, unless a time limit
/// or an interruption ends the run. Throws InputError if a part of the scene is inconsistent.
Result simulate(const SceneParts& parts, const Settings& settings, const Watch& watch = {});

/// The state in which a simulation with these settings begins.
RunState begin(const SceneParts& parts, const Settings& settings);

/// Goes on from a state, with the settings that its phases rest on and other limits: a run that
/// goes on to a number of phases has the bits of one that went there at once. One that goes on to
/// an accuracy may stop a look later than that (see StopRule), because it wants two looks of its
/// own.
/// @param limits  accuracies and number of phases to stop at, the time to stop after from now, and
///     the threads; all else in it is ignored.
void go_on(const SceneParts& parts, const Settings& limits, RunState& state,
           const Watch& watch = {});

}  // namespace lucerna::optics
