// Rays from the observers to the second scattering event.
#pragma once

#include "optics/transport/backward_map.h"
#include "optics/transport/direct_light.h"
#include "optics/transport/readings.h"

namespace lucerna::optics {

/// Which estimator takes which light: every path of light must be counted exactly once.
///
/// With v counting the scattering events from the observer: visible emission is counted by the ray
/// itself; direct light at v = 1 by MIS; the rest by what is set here, in History values or-ed.
struct Collection {
    std::uint8_t first_gather = 0;          ///< v = 1: gathered from the forward map, on surfaces
    std::uint8_t sensor_gather = 0;         ///< v = 1: the same at illuminance points
    std::uint8_t first_deposit = 0;         ///< v = 1: accepted by a backward photon
    std::uint8_t second_deposit = 0;        ///< v = 2: accepted by a backward photon
    bool whole_path = false;                ///< path tracing: direct light at every v, no maps
    bool emission_behind_specular = false;  ///< L S+ D ... E found by the ray itself

    static Collection of(Method method, PlantedError planted);
    bool needs_forward_map(bool has_caustics, bool has_sensors) const;
};

struct BackwardTally {
    std::uint64_t segments = 0, shadow_segments = 0;
};

/// Traces the backward rays of a block of bins: adds visible emission, direct and gathered light to
/// the readings and returns the backward photons. Unbiased but for the kernels of the maps.
std::vector<BackwardPhoton> trace_backward(const Phase& phase, const Collection& collection,
                                           const BinBlock& block, const SensorPlanes& planes,
                                           const ForwardMap& forward_map,
                                           const Radii& forward_radii, Readings& readings,
                                           BackwardTally& tally);

}  // namespace lucerna::optics
