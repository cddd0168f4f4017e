// Rays from the observers to the second scattering event.
#pragma once

#include "optics/transport/backward_map.h"
#include "optics/transport/backward_rays.h"
#include "optics/transport/collection.h"
#include "optics/transport/direct_light.h"
#include "optics/transport/forward_maps.h"
#include "optics/transport/pooled_bias.h"
#include "optics/transport/readings.h"

namespace lucerna::optics {

struct BackwardTally {
    std::uint64_t segments = 0, shadow_segments = 0;
    std::vector<std::uint64_t> lights_found = {};  ///< see BinRays::looks_for; empty: none
    std::vector<CutKernel> cut_kernels = {};       ///< seen by pixels
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
