// The simulation: the phase loop of METHOD section 2.
#pragma once

#include <functional>

#include "optics/scene.h"
#include "optics/transport/result.h"
#include "optics/transport/settings.h"

namespace lucerna::optics {

/// State of a running simulation, for the progress line.
struct Progress {
    std::uint32_t phase = 0;
    double delta = 0.0;
    std::optional<double> delta_wanted;
    double rays_per_s = 0.0;
    double elapsed_s = 0.0;
    std::optional<double> left_s;
};

/// Simulates until the accuracy asked for, the time limit or the number of phases is reached.
/// Throws InputError if a part of the scene is inconsistent.
Result simulate(const SceneParts& parts, const Settings& settings,
                const std::function<void(const Progress&)>& on_progress = {});

}  // namespace lucerna::optics
