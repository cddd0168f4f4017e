#include "optics/transport/forward_rays.h"

#include <algorithm>
#include <iterator>
#include <numeric>

namespace lucerna::optics {
namespace {

constexpr std::uint32_t least_forward_rays = 20000;
constexpr std::size_t pilot_blocks = 128;
// A pilot's photons are a quarter of a phase's: their noise is the larger and shows the better.
constexpr std::uint32_t pilot_share = 4;
// Costs over that of a segment of a forward ray, as measured in two boxes, an office, a room with
// furniture and a light guide, where they differ by a factor of two or so. A segment of a backward
// ray comes with direct light.
constexpr double cost_of_backward_segment = 1.4;
constexpr double cost_of_stored_photon = 0.4, cost_of_gathered_photon = 0.06;
constexpr std::size_t worst_pixels = 1000;  // one in so many
// Pilots are lucky or not; a number further below the usual one is not trusted to them.
constexpr double most_spared = 4.0;
// Runs that stop at their first look gain nothing by long phases: more rays than usual may take so
// much of what the backward rays and the usual ones cost.
constexpr double most_added = 0.5;

// A phase of the same wavelengths whose other random numbers are those of another one.
Phase twin_of(const Phase& phase, std::uint32_t number) {
    Phase twin = phase;
    twin.number = number;
    return twin;
}

// Half of the mean square difference of two traces is the variance of what differs between them.
// Without the worst pixels: a rare bright event in one of them must not decide for all.
double variance_of(const std::vector<RaySums>& one, const std::vector<RaySums>& other) {
    std::vector<double> squares;
    for (std::size_t i = 0; i < one.size(); ++i) {
        squares.push_back(0.5 * square(static_cast<double>(one[i].luminance / one[i].rays -
                                                           other[i].luminance / other[i].rays)));
    }
    const auto end = squares.end() - static_cast<std::ptrdiff_t>(squares.size() / worst_pixels);
    std::nth_element(squares.begin(), end, squares.end());
    return std::accumulate(squares.begin(), end, 0.0);
}

}  // namespace

double rays_that_pay(double rays, const NoiseAndCost& of_map, const NoiseAndCost& of_backward) {
    if (!(of_map.cost > 0.0 && of_backward.variance > 0.0)) return rays;
    return rays *
           std::sqrt(of_map.variance * of_backward.cost / (of_backward.variance * of_map.cost));
}

void choose_forward_rays(const TraceContext& context, const Settings& settings,
                         std::uint32_t pilot_number, Plan& plan) {
    if (settings.forward_rays) return;
    const Stage& stage = context.stage;
    const SceneParts& parts = stage.parts();
    const auto blocks = plan.rays.some_of_images(parts, context.readings, pilot_blocks);
    const auto gathers = [&](History history) {
        return (plan.collections.cameras.first_gather & mask(history)) &&
               plan.gathers(stage, context.planes, history);
    };
    const bool of_indirect = gathers(History::indirect);
    const auto& observers = context.readings.observers();
    const bool only_cameras = std::ranges::all_of(
        observers, [&](const ObserverBins& bins) { return is_camera(parts, bins); });
    const bool of_caustics = only_cameras && gathers(History::caustic);
    if (blocks.empty() || !(of_indirect || of_caustics)) return;

    Plan pilot = plan;
    pilot.caustic_rays = std::max(least_forward_rays, plan.caustic_rays / pilot_share);
    const std::uint32_t least_indirect_rays =
        least_forward_rays / whole_paths_per_path(plan.indirect_reach);
    pilot.indirect_rays = std::max(least_indirect_rays, plan.indirect_rays / pilot_share);
    const Phase phase(stage, settings.seed, pilot_number);
    const Phase twin = twin_of(phase, pilot_number - 1);
    PhaseTrace trace(context);
    ForwardMaps maps = forward_maps(phase, context, pilot, 0, trace);
    // Of the bins of the blocks alone: images may be large.
    const auto read = [&](const Phase& of_rays) {
        const auto all = trace_single_rays(of_rays, context, pilot, maps, blocks);
        std::vector<RaySums> some;
        std::ranges::copy_if(all, std::back_inserter(some),
                             [](const RaySums& sums) { return sums.rays > 0.0f; });
        return some;
    };
    std::vector<RaySums> before = read(phase);
    const RaySums sum = std::accumulate(before.begin(), before.end(), RaySums{},
                                        [](RaySums all, const RaySums& one) { return all += one; });
    // All rays of images over those of the blocks.
    const auto rays_of = [&](std::span<const BinBlock> some) {
        std::uint64_t rays = 0;
        for (const BinBlock& block : some) {
            for (std::size_t bin = block.first; bin < block.last; ++bin) {
                rays += plan.rays.of(block.observer_bins, bin).count;
            }
        }
        return static_cast<double>(rays);
    };
    const double scale =
        rays_of(plan.rays.some_of_images(parts, context.readings, ~0ull)) / rays_of(blocks);
    const NoiseAndCost of_backward{
        variance_of(before, read(twin)),
        cost_of_backward_segment * scale * static_cast<double>(sum.segments)};

    // With other photons in one of the maps.
    const auto rays_for = [&](auto trace_map, const ForwardMap& map, float gathered,
                              std::uint32_t pilot_rays, std::uint32_t usual, std::uint32_t least) {
        const std::uint64_t segments = trace.counts.forward_segments;
        trace_map(twin, context, pilot, 0, maps, trace);
        const std::vector<RaySums> after = read(phase);
        const NoiseAndCost of_map{
            variance_of(before, after),
            static_cast<double>(trace.counts.forward_segments - segments) +
                cost_of_stored_photon * static_cast<double>(map.size()) +
                cost_of_gathered_photon * scale * static_cast<double>(gathered)};
        before = after;
        const double cost_of_ray = of_map.cost / pilot_rays;
        const double added = most_added * (of_backward.cost / cost_of_ray + usual);
        const double rays = std::clamp(rays_that_pay(pilot_rays, of_map, of_backward),
                                       usual / most_spared, usual + added);
        const auto most =
            static_cast<double>(std::max<std::uint64_t>(usual, plan.rays.per_phase()));
        return static_cast<std::uint32_t>(std::clamp<double>(rays, least, most));
    };
    if (of_indirect) {
        plan.indirect_rays = rays_for(trace_indirect_map, maps.indirect, sum.indirect_summed,
                                      pilot.indirect_rays, plan.indirect_rays, least_indirect_rays);
    }
    if (of_caustics) {
        plan.caustic_rays = rays_for(trace_caustic_map, maps.caustic, sum.caustic_summed,
                                     pilot.caustic_rays, plan.caustic_rays, least_forward_rays);
    }
}

}  // namespace lucerna::optics
