// One phase of the combined method (docs/method.md): the page to read first.
//   1 forward trace, caustic          trace_photons(); another for indirect light if that is
//                                     gathered where it is seen
//   2 forward maps                    ForwardMaps
//   3 backward trace                  trace_backward(): emission, direct light, gathered light
//   4 secondary backward map          BackwardMap
//   5 forward trace, secondary        Deposition
//   6 form the images and their error Readings, StopRule, by simulate()
#pragma once

#include "optics/transport/backward_trace.h"
#include "optics/transport/result.h"

namespace lucerna::optics {

/// Forward rays that one task traces.
inline constexpr std::uint32_t forward_rays_per_block = 128;

/// What is chosen before the first phase and then kept: it must not follow what phases find.
struct Plan {
    BackwardRays rays;
    Collections collections;
    std::uint32_t caustic_rays = 0, indirect_rays = 0;  ///< of the forward maps, per phase
    std::uint32_t secondary_rays = 0;                   ///< that deposit in the backward map
    Reach indirect_reach = Reach::whole_path;           ///< of the rays of the indirect map
    Radii caustic_radii, indirect_radii, hidden_radii;  ///< of the first phase
    EmissionGuide caustic_guide;
    bool observed = false;  ///< by any camera or sensor

    /// Whether light of a history is gathered from its forward map by anyone.
    bool gathers(const Stage& stage, const SensorPlanes& planes, History history) const;
    /// The flux balance and the receivers are taken from the secondary trace; without backward
    /// photons from that of the indirect map, if there is one.
    bool traces_secondary(const Stage& stage, const SensorPlanes& planes) const;
};

/// What stays the same for all phases, pilot phases included.
struct TraceContext {
    const Stage& stage;
    const SensorPlanes& planes;
    const Readings& readings;  ///< their bins, not their values
    Scheduler scheduler;
    int threads;
};

/// What a phase leaves behind.
struct PhaseTrace {
    explicit PhaseTrace(const TraceContext& context)
        : readings(context.readings.new_phase()), tally(context.stage.parts()) {}

    PhaseReadings readings;
    ForwardTally tally;              ///< of the rays that the flux balance is taken from
    std::uint64_t balance_rays = 0;  ///< their number
    RayCounts counts;
    std::uint64_t forward_map_bytes = 0, backward_map_bytes = 0;
    std::vector<std::vector<std::uint64_t>> lights_found;  ///< [observer][light], see BinRays
};

/// Photons of the given histories, or-ed, of the rays of a forward trace, in the order of the rays;
/// as the lists of its tasks, and all in one. Behind dispersive glass a ray has a single
/// wavelength, and a phase few of them: light that reaches planes of sensors before it scatters is
/// traced once more, each block of rays with wavelengths of its own, and those photons come last.
std::vector<std::vector<Photon>> trace_photon_lists(const Phase& phase, const TraceContext& context,
                                                    const Emission& emission, Reach reach,
                                                    std::uint8_t histories, std::uint32_t rays,
                                                    ForwardTally& tally);
std::vector<Photon> trace_photons(const Phase& phase, const TraceContext& context,
                                  const Emission& emission, Reach reach, std::uint8_t histories,
                                  std::uint32_t rays, ForwardTally& tally);

/// The forward maps that are gathered from in a phase, with kernels as narrow as in phase number
/// `radii_of`.
ForwardMaps forward_maps(const Phase& phase, const TraceContext& context, const Plan& plan,
                         std::uint32_t radii_of, PhaseTrace& trace);
/// The same, one of them: anew, or for the first time; the other stays as it is.
void trace_caustic_map(const Phase& phase, const TraceContext& context, const Plan& plan,
                       std::uint32_t radii_of, ForwardMaps& maps, PhaseTrace& trace);
void trace_indirect_map(const Phase& phase, const TraceContext& context, const Plan& plan,
                        std::uint32_t radii_of, ForwardMaps& maps, PhaseTrace& trace);

/// What the single backward rays of some blocks of bins read in a phase, per bin.
std::vector<RaySums> trace_single_rays(const Phase& phase, const TraceContext& context,
                                       const Plan& plan, const ForwardMaps& maps,
                                       std::span<const BinBlock> blocks);

/// Traces a phase for some blocks of bins, with kernels as narrow as in phase number `radii_of`.
void trace_phase(const Phase& phase, const TraceContext& context, const Plan& plan,
                 std::span<const BinBlock> blocks, std::uint32_t radii_of, PhaseTrace& trace);

}  // namespace lucerna::optics
