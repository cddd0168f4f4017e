// The simulation: the phase loop of METHOD section 2.
#pragma once

#include <atomic>
#include <functional>

#include "optics/scene.h"
#include "optics/transport/result.h"
#include "optics/transport/settings.h"

namespace lucerna::optics {

/// State of a running simulation, for the progress line.
struct Progress {
    std::uint32_t phase = 0;  ///< phases done
    double delta = 0.0;       ///< METHOD eq. (6); not a number before two phases
    std::optional<double> delta_wanted;
    double rays_per_s = 0.0;
    double elapsed_s = 0.0;
    std::optional<double> left_s;
};

/// Simulates until the accuracy asked for, the time limit or the number of phases is reached;
/// without any of them until the images have delta = 2 % and the sensors a standard error of 1 %.
/// Same scene, settings and seed give the same bits for any number of threads, unless a time limit
/// or an interruption ends the run. Throws InputError if a part of the scene is inconsistent.
/// @param interrupted  checked after each phase; the result so far is returned when it turns true.
Result simulate(const SceneParts& parts, const Settings& settings,
                const std::function<void(const Progress&)>& on_progress = {},
                const std::atomic<bool>* interrupted = nullptr);

}  // namespace lucerna::optics
