// How fast rays are traced, against the bare ray caster on the same rays.
#pragma once

#include "optics/scene.h"
#include "optics/transport/settings.h"

namespace lucerna::optics {

/// Single-thread rates of one kind of trace; the best of several interleaved repetitions.
struct TraceRate {
    std::uint64_t rays = 0;     ///< segments and shadow rays of a repetition
    double traced_per_s = 0.0;  ///< with all shading
    double raw_per_s = 0.0;     ///< nearest hit of the same rays, nothing else
    double fraction() const { return raw_per_s > 0.0 ? traced_per_s / raw_per_s : 0.0; }
};

struct TraceRates {
    TraceRate forward;   ///< whole paths from the lights, without deposits
    TraceRate backward;  ///< from the observers to the second scattering event, no map attached
};

/// Traces at most `max_paths` paths of the first phase of each kind.
TraceRates measure_trace_rates(const SceneParts& parts, const Settings& settings,
                               std::uint32_t max_paths);

}  // namespace lucerna::optics
