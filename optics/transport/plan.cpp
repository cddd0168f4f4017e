#include "optics/transport/plan.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "optics/transport/emission_pilot.h"
#include "optics/transport/forward_rays.h"
#include "optics/transport/sensor_pilot.h"
#include "optics/transport/sensor_radii.h"

namespace lucerna::optics {
namespace {

constexpr std::uint32_t min_pilot_rays = 1 << 14, max_pilot_rays = 1 << 15;
// That tell how wide the kernels of sensors may be, for the guide and for good.
constexpr std::uint32_t rays_to_learn_widths = 1 << 16, rays_to_widen = 1 << 18;
constexpr double default_sensor_accuracy = 0.02;  // where none is asked for
// What the choice of the collection for images is made from.
constexpr std::uint32_t pilot_phases = 3;
constexpr std::size_t pilot_blocks = 96;
// That tell where kernels of pixels are cut or biased.
constexpr std::uint32_t phases_to_look = 3;
constexpr std::uint32_t min_forward_rays = 20000;
// Secondary forward rays per backward ray: their noise is averaged over all second scattering
// events that a kernel serves, so that few are enough (the same delta with 1 and with 1/4 in
// diffuse rooms).
constexpr std::uint64_t backward_per_secondary_ray = 16;
// The guide sends most of them where they are of use: half as many and twice as many, or kernels of
// 50 and 200 photons, have a larger error at equal time in a box with glass and mirror balls.
constexpr std::uint64_t backward_per_caustic_ray = 4;
// Expected photons in a kernel of the first phase: few where the kernel is hidden behind a
// scattering event, many where it is seen, unless its bias there is large. Sensors start with few,
// and get more where the bias is shown to be small.
constexpr double photons_per_hidden_kernel = 16.0;
constexpr double photons_per_kernel_of_images = 100.0;
constexpr double photons_per_kernel_of_meters = 24.0;
constexpr double photons_per_sensor_kernel = 24.0;
// Where all indirect light is gathered at seen surfaces, it is mostly smooth: kernels are as wide
// as their bias allows. For each ray that a gather stands for, this many photons in the kernel, on
// average: with half as many or twice as many an error of 2 % is reached later in a diffuse room.
constexpr double photons_per_ray_of_wide_kernel = 16.0;
// Pilot phases are numbered from the end.
constexpr std::uint32_t pilot_phase = std::numeric_limits<std::uint32_t>::max();

std::uint32_t at_least_min(std::uint64_t rays) {
    return static_cast<std::uint32_t>(std::max<std::uint64_t>(min_forward_rays, rays));
}

// Kernels of caustics that sensors read; false if none does.
bool widen_around_sensors(const TraceContext& context, const Settings& settings,
                          const SeenPoints& seen, std::uint32_t least_rays, Plan& plan) {
    constexpr std::size_t most_points = 16;  // of a target
    std::vector<ReadPoint> points;
    for (std::uint32_t target = 0; target < seen.target_count(); ++target) {
        if (seen.of_images[target]) continue;
        std::vector<ReadPoint> own;
        for (std::size_t i = 0; i < seen.vertices.size(); ++i) {
            if (seen.targets[i] == target)
                own.push_back({seen.vertices[i].point, seen.vertices[i].bin});
        }
        const std::size_t step = std::max<std::size_t>(1, own.size() / most_points);
        for (std::size_t i = 0; i < own.size(); i += step) points.push_back(own[i]);
    }
    if (points.empty()) return false;
    const std::uint32_t rays = std::max(plan.caustic_rays, least_rays);
    double accuracy = settings.sensor_accuracy.value_or(default_sensor_accuracy);
    for (const SensorTarget& target : settings.sensor_targets) {
        if (target.relative > 0.0) accuracy = std::min(accuracy, target.relative);
    }
    const auto pilot = [&](std::uint32_t number) {
        const Phase phase(context.stage, settings.seed, number);
        const Emission emission(phase, RandomPurpose::caustic, plan.caustic_guide, rays);
        ForwardTally unused(context.stage.parts());
        return PilotPhotons{trace_photons(phase, context, emission, Reach::first_scattering,
                                          mask(History::caustic), rays, unused),
                            rays, phase.wavelengths.luminance};
    };
    plan.caustic_radii =
        widened_around(context.stage, context.planes, plan.caustic_radii,
                       pilot(pilot_phase - pilot_phases - 2), pilot(pilot_phase - pilot_phases - 3),
                       points, accuracy, plan.caustic_rays, context.threads);
    return true;
}

// Radii and rays of the maps, from the rays of a pilot phase.
void choose_radii(const TraceContext& context, const Settings& settings, Plan& plan) {
    const Stage& stage = context.stage;
    const Phase phase(stage, settings.seed, pilot_phase);
    ForwardTally unused(stage.parts());
    constexpr std::uint8_t all =
        mask(History::direct) | mask(History::caustic) | mask(History::indirect);
    const std::uint32_t rays = std::clamp(std::max(plan.caustic_rays, plan.secondary_rays),
                                          min_pilot_rays, max_pilot_rays);
    const PilotPhotons photons{trace_photons(phase, context, Emission(phase, RandomPurpose::pilot),
                                             Reach::whole_path, all, rays, unused),
                               rays, phase.wavelengths.luminance};
    const auto of = [&](History history) {
        PilotPhotons some{{}, rays, phase.wavelengths.luminance};
        for (const Photon& photon : photons.photons) {
            if (photon.history == history) some.photons.push_back(photon);
        }
        return some;
    };
    const auto& observers = stage.parts().observers;
    // What a luminance meter reads has little noise, and bounds that hold need little bias.
    const bool meters = std::any_of(observers.begin(), observers.end(), [](const Observer& o) {
        return std::holds_alternative<LuminanceMeter>(o);
    });
    const auto choose_caustic_radii = [&](const PilotPhotons& caustic) {
        plan.caustic_radii =
            narrow_radii(stage, context.planes, caustic,
                         {meters ? photons_per_kernel_of_meters : photons_per_kernel_of_images,
                          photons_per_sensor_kernel},
                         plan.caustic_rays, true, context.threads);
    };
    choose_caustic_radii(of(History::caustic));
    if (plan.gathers(stage, context.planes, History::caustic)) {
        const SeenPoints seen = seen_points(phase, context, settings);
        const auto learn_guide = [&] {
            plan.caustic_guide =
                guide_of_caustics(phase, context, seen, plan.caustic_radii, photons);
        };
        learn_guide();
        // Beside bright caustics the kernels of a place that fit them find nothing of faint ones.
        if (plan.caustic_guide.empty() &&
            widen_around_sensors(context, settings, seen, rays_to_learn_widths, plan)) {
            learn_guide();
        }
        if (!plan.caustic_guide.empty()) {
            const Emission guided(phase, RandomPurpose::pilot, plan.caustic_guide);
            choose_caustic_radii({trace_photons(phase, context, guided, Reach::first_scattering,
                                                mask(History::caustic), rays, unused),
                                  rays, phase.wavelengths.luminance});
            // Wide kernels read light that a guide for narrow ones has left to few heavy rays.
            // Without dispersion these are spread so evenly that another guide would do harm.
            if (stage.disperses() &&
                widen_around_sensors(context, settings, seen, rays_to_learn_widths, plan)) {
                learn_guide();
            }
            widen_around_sensors(context, settings, seen, rays_to_widen, plan);
        }
    }
    plan.hidden_radii = narrow_radii(stage, context.planes, photons,
                                     {photons_per_hidden_kernel, photons_per_hidden_kernel},
                                     plan.secondary_rays, false, context.threads);
    const PilotPhotons indirect = of(History::indirect);
    plan.indirect_radii = wide_radii(stage, context.planes, indirect, context.threads);
    plan.indirect_rays = settings.forward_rays.value_or(
        std::clamp(rays_for(stage, indirect, plan.indirect_radii,
                            photons_per_ray_of_wide_kernel * plan.rays.per_gather()),
                   min_forward_rays, at_least_min(plan.rays.per_phase())) /
        whole_paths_per_path(plan.indirect_reach));
}

// Which of both ways to collect indirect light has less noise in a phase: the variance over pilot
// phases of the same pixels, that of emission and direct light apart.
void choose_collection_of_images(const TraceContext& context, const Settings& settings,
                                 Plan& plan) {
    const std::vector<BinBlock> blocks =
        plan.rays.some_of_images(context.stage.parts(), context.readings, pilot_blocks);
    if (blocks.empty()) return;
    const auto noise = [&](const Collection& collection, std::uint32_t indirect_rays) {
        Plan pilot = plan;
        pilot.collections = {collection, collection};
        pilot.indirect_rays = indirect_rays;
        Readings readings = context.readings;
        PhaseTrace trace(context);
        for (std::uint32_t i = 1; i <= pilot_phases; ++i) {
            const Phase phase(context.stage, settings.seed, pilot_phase - i);
            trace_phase(phase, context, pilot, blocks, 0, trace);
            readings.fold(phase, trace.readings, context.threads);
        }
        return readings.image_variance();
    };
    Collection combined = plan.collections.cameras;
    Collection merged = Collection::merged_where_seen();
    // Caustics are collected alike in both.
    combined.first_gather = 0;
    merged.first_gather = mask(History::indirect);
    // The noise of a map falls with its rays, that of single rays to a second scattering event does
    // not.
    const std::uint32_t rays = min_pilot_rays / whole_paths_per_path(plan.indirect_reach);
    const double of_merged = noise(merged, rays) * rays / plan.indirect_rays;
    if (of_merged < noise(combined, rays)) {
        plan.collections.cameras = Collection::merged_where_seen();
    }
}

// What the single rays of a pilot phase read.
std::vector<RaySums> pilot_rays(const Phase& phase, const TraceContext& context,
                                const Plan& pilot) {
    PhaseTrace unused(context);
    return trace_single_rays(phase, context, pilot, forward_maps(phase, context, pilot, 0, unused),
                             pilot.rays.blocks());
}

// Finds out which pixels have kernels that barriers cut or that should be narrower.
void look_at_kernels(const TraceContext& context, const Settings& settings, Plan& plan) {
    const auto gathers = [&](History history) {
        return (plan.collections.cameras.first_gather & mask(history)) &&
               plan.gathers(context.stage, context.planes, history);
    };
    if (!gathers(History::caustic) && !gathers(History::indirect)) return;
    const SceneParts& parts = context.stage.parts();
    Plan pilot = plan;
    pilot.caustic_rays = min_forward_rays;
    pilot.rays = BackwardRays::through_tiles(parts, context.readings);
    if (pilot.rays.blocks().empty()) return;
    std::vector<std::vector<RaySums>> sums;
    // The bias of caustics is judged by their surfaces alone.
    const std::uint32_t phases = gathers(History::indirect) ? phases_to_look : 1;
    for (std::uint32_t i = 0; i < phases; ++i) {
        const Phase phase(context.stage, settings.seed, pilot_phase - pilot_phases - 4 - i);
        sums.push_back(pilot_rays(phase, context, pilot));
    }
    plan.rays.look_at_kernels(parts, context.readings, sums, context.threads);
}

// More rays for pixels with more noise. A user who states the rays of a pixel gets just those.
void share_out_rays(const TraceContext& context, const Settings& settings, Plan& plan) {
    const SceneParts& parts = context.stage.parts();
    Plan pilot = plan;
    // What rays of the same surface gather has hardly a say: few photons do.
    pilot.caustic_rays = at_least_min(plan.caustic_rays / 4);
    pilot.indirect_rays = std::max(min_forward_rays / whole_paths_per_path(plan.indirect_reach),
                                   plan.indirect_rays / 4);
    pilot.rays = BackwardRays::of_pilot(parts, context.readings, 4);
    pilot.rays.take_kernels(plan.rays);
    if (pilot.rays.blocks().empty()) return;
    const Phase phase(context.stage, settings.seed, pilot_phase - pilot_phases - 1);
    plan.rays.share_out(parts, context.readings, pilot_rays(phase, context, pilot),
                        plan.collections.cameras.reaches_second_event(), context.threads);
}

}  // namespace

Plan make_plan(const TraceContext& context, const Settings& settings) {
    Plan plan;
    plan.rays = {context.stage.parts(), context.readings, settings};
    const Collection collection = Collection::of(settings.method, settings.planted_error);
    plan.collections = {collection, collection};
    const std::uint64_t samples = plan.rays.per_phase();
    plan.caustic_rays =
        settings.forward_rays.value_or(at_least_min(samples / backward_per_caustic_ray));
    plan.secondary_rays =
        settings.forward_rays.value_or(at_least_min(samples / backward_per_secondary_ray));
    plan.observed = !plan.rays.blocks().empty();
    if (!plan.observed) return plan;
    // The noise of receivers falls with the rays that leave the lights.
    if (context.stage.parts().receivers.empty()) plan.indirect_reach = Reach::whole_path_split;
    choose_radii(context, settings, plan);
    const Phase of_sensors(context.stage, settings.seed, pilot_phase - pilot_phases - 7);
    prepare_sensors(of_sensors, context, settings, plan);
    if (settings.method == Method::automatic) choose_collection_of_images(context, settings, plan);
    const auto& observers = context.readings.observers();
    const bool only_cameras =
        std::all_of(observers.begin(), observers.end(),
                    [&](const auto& bins) { return is_camera(context.stage.parts(), bins); });
    if (only_cameras) plan.collections.sensors = plan.collections.cameras;
    look_at_kernels(context, settings, plan);
    if (!settings.samples_per_pixel) share_out_rays(context, settings, plan);
    choose_forward_rays(context, settings, pilot_phase - pilot_phases - 8, plan);
    return plan;
}

}  // namespace lucerna::optics
