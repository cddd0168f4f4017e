#include "optics/transport/phase_trace.h"

#include <algorithm>

#include "core/parallel.h"
#include "core/stopwatch.h"
#include "optics/transport/groups.h"

namespace lucerna::optics {
namespace {

constexpr std::uint32_t blocks_per_chunk = 256;  // deposits of a chunk are held at once
// That share wavelengths where those of the phase would be too few: to look up all spectra for them
// takes about a tenth of their time.
constexpr std::uint32_t rays_of_own_wavelengths = 32;

std::uint32_t block_count(std::uint32_t rays) {
    return (rays + forward_rays_per_block - 1) / forward_rays_per_block;
}

// Whether light that reaches planes of sensors is traced by rays of its own, which have wavelengths
// of their own.
bool traces_planes_apart(const TraceContext& context, Reach reach) {
    return reach == Reach::first_scattering && context.stage.disperses() &&
           context.planes.count() > 0;
}

// How often a trace follows each of its rays.
std::uint32_t times_traced(const TraceContext& context, Reach reach) {
    return traces_planes_apart(context, reach) && context.stage.has_scattering() ? 2 : 1;
}

// The photons of one history.
ForwardMap forward_map(const Phase& phase, const TraceContext& context, History history,
                       const Emission& emission, Reach reach, std::uint32_t rays,
                       const Radii& radii, ForwardTally& tally, RayCounts& counts) {
    const Stopwatch watch;
    const auto photons =
        trace_photon_lists(phase, context, emission, reach, mask(history), rays, tally);
    counts.caustic_s += watch.seconds();
    counts.caustic_rays += std::uint64_t{times_traced(context, reach)} * rays;
    counts.forward_segments += tally.segments;
    const Stopwatch map_watch;
    ForwardMap map(context.stage, radii, photons, rays, context.threads);
    counts.forward_photons += map.size();
    counts.maps_s += map_watch.seconds();
    return map;
}

// Secondary rays, and what they deposit. Without backward photons (path tracing) they serve
// receivers and flux balance.
void deposit(const Phase& phase, const TraceContext& context, std::uint32_t rays, BackwardMap& map,
             PhaseTrace& trace) {
    const Emission emission(phase, RandomPurpose::secondary);
    const std::uint32_t blocks = block_count(rays);
    const bool locked = context.scheduler == Scheduler::synchronous;
    for (std::uint32_t chunk = 0; chunk < blocks; chunk += blocks_per_chunk) {
        const std::uint32_t count = std::min(blocks_per_chunk, blocks - chunk);
        std::vector<BackwardMap::Deposits> deposits(locked ? 0 : count);
        std::vector<ForwardTally> tallies(count);
        std::vector<std::uint64_t> hits(count),
            applied(std::max<std::size_t>(count, BackwardMap::parts));
        for_each_block(count, context.threads, [&](std::size_t block) {
            const std::uint32_t first =
                (chunk + static_cast<std::uint32_t>(block)) * forward_rays_per_block;
            ForwardTally counted(context.stage.parts());
            BackwardMap::Deposits found;
            for (std::uint32_t i = first; i < std::min(rays, first + forward_rays_per_block); ++i) {
                trace_forward(phase, emission, i, Reach::whole_path, nullptr, counted,
                              [&](const Photon& photon) {
                                  ++hits[block];
                                  if (locked) {
                                      applied[block] += map.deposit_locked(photon);
                                  } else {
                                      map.find(photon, found);
                                  }
                              });
            }
            tallies[block] = std::move(counted);
            if (!locked) deposits[block] = std::move(found);
        });
        if (!locked) {
            for_each_block(BackwardMap::parts, context.threads,
                           [&](std::size_t part) { applied[part] = map.apply(part, deposits); });
        }
        for (std::uint32_t block = 0; block < count; ++block) {
            trace.tally += tallies[block];
            trace.counts.scattering_hits += hits[block];
        }
        for (const std::uint64_t deposited : applied) trace.counts.deposits += deposited;
        // To free so many small lists takes a while.
        for_each_block(deposits.size(), context.threads, [&](std::size_t i) { deposits[i] = {}; });
    }
    trace.balance_rays = rays;
    trace.counts.secondary_rays += rays;
    trace.counts.forward_segments += trace.tally.segments;
}

}  // namespace

bool Plan::gathers(const Stage& stage, const SensorPlanes& planes, History history) const {
    if (!observed || (history == History::caustic && !stage.has_caustics())) return false;
    if (history == History::caustic && rays.look_for_all()) return false;
    std::uint8_t wanted = collections.cameras.first_gather | collections.sensors.first_gather;
    if (planes.count() > 0) wanted |= collections.sensors.sensor_gather;
    return wanted & mask(history);
}

bool Plan::traces_secondary(const Stage& stage, const SensorPlanes& planes) const {
    return collections.deposits() || !gathers(stage, planes, History::indirect);
}

std::vector<std::vector<Photon>> trace_photon_lists(const Phase& phase, const TraceContext& context,
                                                    const Emission& emission, Reach reach,
                                                    std::uint8_t histories, std::uint32_t rays,
                                                    ForwardTally& tally) {
    const Stage& stage = context.stage;
    const bool own_wavelengths = traces_planes_apart(context, reach);
    const std::uint32_t blocks = block_count(rays);
    const std::uint32_t tasks = own_wavelengths ? 2 * blocks : blocks;
    std::vector<std::vector<Photon>> photons(tasks);
    std::vector<ForwardTally> tallies(tasks);
    for_each_block(tasks, context.threads, [&](std::size_t task) {
        std::vector<Photon> found;
        ForwardTally counted(stage.parts());
        const auto trace = [&](const Phase& of_rays, std::uint32_t first, std::uint32_t end,
                               bool surfaces, bool planes) {
            for (std::uint32_t i = first; i < end; ++i) {
                trace_forward(of_rays, emission, i, reach, planes ? &context.planes : nullptr,
                              counted, [&](const Photon& photon) {
                                  if ((histories & mask(photon.history)) &&
                                      (surfaces || photon.point.object == no_object)) {
                                      found.push_back(photon);
                                  }
                              });
            }
        };
        const std::uint32_t first =
            static_cast<std::uint32_t>(task) % blocks * forward_rays_per_block;
        const std::uint32_t end = std::min(rays, first + forward_rays_per_block);
        if (task >= blocks) {
            for (std::uint32_t i = first; i < end; i += rays_of_own_wavelengths) {
                const Phase own(stage, phase.seed, phase.number, i / rays_of_own_wavelengths + 1);
                trace(own, i, std::min(end, i + rays_of_own_wavelengths), false, true);
            }
        } else if (stage.has_scattering() || !own_wavelengths) {
            trace(phase, first, end, true, !own_wavelengths);
        }
        // Only now: what stands beside them in the lists is other threads'.
        photons[task] = std::move(found);
        tallies[task] = std::move(counted);
    });
    for (std::uint32_t task = 0; task < tasks; ++task) {
        if (task < blocks) {
            tally += tallies[task];
        } else {
            tally.segments += tallies[task].segments;
        }
    }
    return photons;
}

std::vector<Photon> trace_photons(const Phase& phase, const TraceContext& context,
                                  const Emission& emission, Reach reach, std::uint8_t histories,
                                  std::uint32_t rays, ForwardTally& tally) {
    std::vector<Photon> all;
    for (const auto& list :
         trace_photon_lists(phase, context, emission, reach, histories, rays, tally)) {
        all.insert(all.end(), list.begin(), list.end());
    }
    return all;
}

void trace_caustic_map(const Phase& phase, const TraceContext& context, const Plan& plan,
                       std::uint32_t radii_of, ForwardMaps& maps, PhaseTrace& trace) {
    maps.caustic_radii = plan.caustic_radii.at_phase(radii_of);
    ForwardTally unused(context.stage.parts());
    const Emission emission(phase, RandomPurpose::caustic, plan.caustic_guide, plan.caustic_rays);
    // Caustics need no path beyond the first scattering event.
    maps.caustic = forward_map(phase, context, History::caustic, emission, Reach::first_scattering,
                               plan.caustic_rays, maps.caustic_radii, unused, trace.counts);
}

void trace_indirect_map(const Phase& phase, const TraceContext& context, const Plan& plan,
                        std::uint32_t radii_of, ForwardMaps& maps, PhaseTrace& trace) {
    maps.indirect_radii = plan.indirect_radii.at_phase(radii_of);
    ForwardTally tally(context.stage.parts());
    const Emission emission(phase, RandomPurpose::indirect, EmissionGuide{}, plan.indirect_rays);
    maps.indirect = forward_map(phase, context, History::indirect, emission, plan.indirect_reach,
                                plan.indirect_rays, maps.indirect_radii, tally, trace.counts);
    if (!plan.traces_secondary(context.stage, context.planes)) {
        trace.tally = tally;
        trace.balance_rays = plan.indirect_rays;
    }
}

ForwardMaps forward_maps(const Phase& phase, const TraceContext& context, const Plan& plan,
                         std::uint32_t radii_of, PhaseTrace& trace) {
    ForwardMaps maps;
    if (plan.gathers(context.stage, context.planes, History::caustic)) {
        trace_caustic_map(phase, context, plan, radii_of, maps, trace);
    }
    if (plan.gathers(context.stage, context.planes, History::indirect)) {
        trace_indirect_map(phase, context, plan, radii_of, maps, trace);
    }
    trace.forward_map_bytes = maps.caustic.bytes() + maps.indirect.bytes();
    return maps;
}

std::vector<RaySums> trace_single_rays(const Phase& phase, const TraceContext& context,
                                       const Plan& plan, const ForwardMaps& maps,
                                       std::span<const BinBlock> blocks) {
    PhaseReadings unused_readings = context.readings.new_phase();
    std::vector<RaySums> sums(context.readings.bin_count());
    for_each_block(blocks.size(), context.threads, [&](std::size_t i) {
        BackwardTally unused;
        trace_backward(phase, plan.collections,
                       context.readings.observers()[blocks[i].observer_bins], plan.rays, blocks[i],
                       context.planes, maps, unused_readings, unused, &sums);
    });
    return sums;
}

void trace_phase(const Phase& phase, const TraceContext& context, const Plan& plan,
                 std::span<const BinBlock> blocks, std::uint32_t radii_of, PhaseTrace& trace) {
    const ForwardMaps maps = forward_maps(phase, context, plan, radii_of, trace);
    const Radii hidden_radii = plan.hidden_radii.at_phase(radii_of);
    const bool secondary = plan.traces_secondary(context.stage, context.planes);
    for (const BinBlock& block : blocks) {
        for (std::size_t bin = block.first; bin < block.last; ++bin) {
            trace.counts.backward_rays += plan.rays.of(block.observer_bins, bin).count;
        }
    }
    if (secondary && context.scheduler == Scheduler::two_level) {
        trace_in_groups(phase, context, plan, blocks, maps, hidden_radii, trace);
        return;
    }

    const Stopwatch backward_watch;
    std::vector<std::vector<BackwardPhoton>> stored(blocks.size());
    std::vector<BackwardTally> backward_tallies(blocks.size());
    for_each_block(blocks.size(), context.threads, [&](std::size_t i) {
        BackwardTally counted;
        stored[i] = trace_backward(phase, plan.collections,
                                   context.readings.observers()[blocks[i].observer_bins], plan.rays,
                                   blocks[i], context.planes, maps, trace.readings, counted);
        backward_tallies[i] = std::move(counted);
    });
    std::vector<std::vector<CutKernel>> cut_kernels;
    for (BackwardTally& tally : backward_tallies) {
        cut_kernels.push_back(std::move(tally.cut_kernels));
    }
    add_pooled_bias(cut_kernels, context.threads, trace.readings);
    trace.counts.backward_s += backward_watch.seconds();
    trace.lights_found.resize(context.readings.observers().size());
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        const BackwardTally& block = backward_tallies[i];
        trace.counts.backward_segments += block.segments;
        trace.counts.shadow_segments += block.shadow_segments;
        std::vector<std::uint64_t>& found = trace.lights_found[blocks[i].observer_bins];
        found.resize(std::max(found.size(), block.lights_found.size()));
        for (std::size_t light = 0; light < block.lights_found.size(); ++light) {
            found[light] += block.lights_found[light];
        }
    }
    if (!secondary) return;

    const Stopwatch map_watch;
    BackwardMap map(phase, hidden_radii, std::move(stored), context.threads);
    trace.counts.maps_s += map_watch.seconds();
    trace.counts.backward_photons += map.size();
    trace.backward_map_bytes = map.bytes();
    const Stopwatch watch;
    deposit(phase, context, plan.secondary_rays, map, trace);
    trace.counts.secondary_s += watch.seconds();
    const Stopwatch read_watch;
    for_each_block(blocks.size(), context.threads, [&](std::size_t i) {
        map.read(i, plan.secondary_rays,
                 [&](std::uint32_t bin, const Lanes& radiance, const Lanes& bias) {
                     trace.readings.add(phase, bin, radiance, bias);
                 });
    });
    trace.counts.readings_s += read_watch.seconds();
}

}  // namespace lucerna::optics
