// Rays from the observers to the second scattering event.
#pragma once

#include "optics/transport/backward_map.h"
#include "optics/transport/backward_rays.h"
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
    bool second_direct = false;             ///< v = 2: direct light by MIS, too
    std::uint8_t second_deposit = 0;        ///< v = 2: accepted by a backward photon
    bool whole_path = false;                ///< path tracing: direct light at every v, no maps
    bool emission_behind_specular = false;  ///< L S+ D ... E found by the ray itself

    bool deposits() const { return first_deposit || second_deposit; }

    /// Whether its rays go on to a second scattering event, which brings noise to all pixels.
    bool reaches_second_event() const { return second_deposit || whole_path; }

    static Collection of(Method method, PlantedError planted);
    /// Of images under Method::automatic where kernels at seen surfaces have less noise than rays
    /// to a second scattering event: indirect light is gathered where it is seen.
    static Collection merged_where_seen();
};

/// The collections of the two kinds of observers.
struct Collections {
    Collection cameras, sensors;

    bool deposits() const { return cameras.deposits() || sensors.deposits(); }
};

struct BackwardTally {
    std::uint64_t segments = 0, shadow_segments = 0;
    std::vector<std::uint64_t> lights_found = {};  ///< see BinRays::looks_for; empty: none
};

/// Traces the backward rays of a block of bins of an observer: adds visible emission, direct and
/// gathered light to the readings and returns the backward photons. Unbiased but for the kernels of
/// the maps.
/// @param sums  if given, of the single rays of all bins: what they read without later deposits.
std::vector<BackwardPhoton> trace_backward(const Phase& phase, const Collections& collections,
                                           const ObserverBins& bins, const BackwardRays& rays,
                                           const BinBlock& block, const SensorPlanes& planes,
                                           const ForwardMaps& maps, PhaseReadings& readings,
                                           BackwardTally& tally,
                                           std::vector<RaySums>* sums = nullptr);

}  // namespace lucerna::optics
