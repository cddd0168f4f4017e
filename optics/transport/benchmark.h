// How fast the parts of the engine work, each measured by itself.
#pragma once

#include <cstdint>
#include <vector>

#include "optics/scene.h"
#include "optics/transport/settings.h"

namespace lucerna::optics {

/// What a part works through per second; the best of several repetitions.
struct Rate {
    std::uint64_t items = 0;    ///< of a repetition
    std::vector<double> per_s;  ///< per number of threads; empty without items
};

/// The rays of a trace: segments and shadow rays.
struct TraceRates {
    Rate bare;    ///< nearest hit, nothing else
    Rate traced;  ///< with all shading
    /// Share of the bare rate that is left with the i-th number of threads.
    double fraction(std::size_t i) const { return traced.per_s[i] / bare.per_s[i]; }
};

struct ForwardMapRates {
    Rate build;   ///< photons
    Rate gather;  ///< points on seen surfaces
};

struct BackwardMapRates {
    Rate build;    ///< vertices of backward rays
    Rate find;     ///< photons of forward rays looked up
    Rate deposit;  ///< pairs of vertex and photon applied
};

struct Rates {
    std::vector<int> threads;
    TraceRates forward;   ///< paths of the map of indirect light
    TraceRates backward;  ///< from the observers to the second scattering event, no map attached
    BackwardMapRates backward_map;
    ForwardMapRates caustic_map, indirect_map;
};

struct RateEffort {
    std::uint32_t paths = 100000;  ///< at most, of each kind of trace, and of gathers
    std::vector<int> threads{1};
    int repetitions = 5;
};

/// Measures rays of the first phase, and its maps with their radii and numbers of rays. All maps
/// are measured that the scene has light for, whichever its method uses. What is compared takes
/// turns, so that all of it meets the same disturbances of the machine. Throws InputError if a part
/// of the scene is inconsistent.
Rates measure_rates(const SceneParts& parts, const Settings& settings, const RateEffort& effort);

}  // namespace lucerna::optics
