#include "optics/transport/sensor_pilot.h"

#include <algorithm>

#include "optics/transport/arrival_density.h"

namespace lucerna::optics {
namespace {

constexpr std::uint32_t rays_to_guide = 1 << 16;
constexpr std::uint32_t phases_to_compare = 4;
// Lights that are found so often by the rays of a sensor bin in all pilot phases together are found
// often enough by those of a run: a single ray then never weighs much.
constexpr std::uint64_t least_found_per_bin = 32;

// Those with a surface that a ray can meet.
std::vector<bool> lights_with_surface(const Stage& stage) {
    std::vector<bool> lights(stage.parts().lights.size());
    for (ObjectId object = 0; object < stage.parts().objects.size(); ++object) {
        const std::uint32_t light = stage.light_of(object);
        if (light != no_light) lights[light] = true;
    }
    return lights;
}

// Readings of sensors over pilot phases, of light that comes by way of specular events and of what
// the first scattered rays find else.
struct PilotReadings {
    std::vector<Quantity> quantities;
    std::vector<std::uint64_t> lights_found;
};

PilotReadings read(const Phase& first, const TraceContext& context, const Plan& plan) {
    Plan pilot = plan;
    pilot.collections.sensors.second_direct = false;
    pilot.collections.sensors.second_deposit = 0;
    pilot.secondary_rays = forward_rays_per_block;
    std::vector<BinBlock> blocks;
    for (const BinBlock& block : plan.rays.blocks()) {
        if (!is_camera(context.stage.parts(), context.readings.observers()[block.observer_bins]))
            blocks.push_back(block);
    }
    // Any scheduler decides alike.
    TraceContext ordered = context;
    ordered.scheduler = Scheduler::ordered;
    Readings readings = context.readings;
    PhaseTrace trace(ordered);
    for (std::uint32_t i = 1; i <= phases_to_compare; ++i) {
        const Phase phase(context.stage, first.seed, first.number - i);
        trace_phase(phase, ordered, pilot, blocks, 0, trace);
        readings.fold(phase, trace.readings, context.threads);
    }
    return {readings.quantities(context.stage.parts()), trace.lights_found};
}

// Sums over the sensors of the relative variances.
std::array<double, 2> variances(const PilotReadings& one, const PilotReadings& other) {
    std::array<double, 2> sums{};
    for (std::size_t i = 0; i < one.quantities.size(); ++i) {
        const Estimate& a = one.quantities[i].estimate;
        const Estimate& b = other.quantities[i].estimate;
        const double value_square = square(0.5 * (a.mean() + b.mean()));
        if (!(value_square > 0.0) || a.count() < 2 || b.count() < 2) continue;
        sums[0] += square(a.standard_error()) / value_square;
        sums[1] += square(b.standard_error()) / value_square;
    }
    return sums;
}

}  // namespace

void prepare_sensors(const Phase& first, const TraceContext& context, const Settings& settings,
                     Plan& plan) {
    const Stage& stage = context.stage;
    std::uint64_t bins_of_sensors = 0;
    for (const ObserverBins& bins : context.readings.observers()) {
        if (!is_camera(context.stage.parts(), bins)) bins_of_sensors += bins.count;
    }
    if (bins_of_sensors == 0 || !plan.collections.sensors.reaches_second_event()) return;

    ForwardTally unused(stage.parts());
    const std::uint8_t histories = mask(History::indirect) | mask(History::caustic);
    const PilotPhotons photons{trace_photons(first, context, Emission(first, RandomPurpose::pilot),
                                             Reach::whole_path, histories, rays_to_guide, unused),
                               rays_to_guide};
    const SeenPoints seen = seen_points(first, context, settings);
    const auto scatter_for = [&](const std::vector<bool>& behind_specular) {
        scatter_to_arrivals(
            first, context, seen, photons,
            [&](const Photon& photon) {
                return photon.history == History::indirect ||
                       (!behind_specular.empty() && behind_specular[photon.light]);
            },
            plan.rays);
    };
    std::vector<bool> lights = lights_with_surface(stage);
    const auto any = [&] { return std::ranges::count(lights, true) > 0; };
    const Collection& collection = plan.collections.sensors;
    if (!plan.gathers(stage, context.planes, History::caustic) || !collection.second_direct) {
        return scatter_for(collection.emission_behind_specular ? lights : std::vector<bool>{});
    }
    const PilotReadings by_maps = read(first, context, plan);
    PilotReadings by_rays;
    bool all_are_found = false;
    while (any() && !all_are_found) {
        scatter_for(lights);
        plan.collections.found_by_sensors = lights;
        by_rays = read(first, context, plan);
        all_are_found = true;
        for (std::size_t light = 0; light < lights.size(); ++light) {
            if (!lights[light] ||
                by_rays.lights_found[light] >= least_found_per_bin * bins_of_sensors) {
                continue;
            }
            lights[light] = all_are_found = false;
        }
    }
    if (any()) {
        const auto [variance_of_maps, variance_of_rays] = variances(by_maps, by_rays);
        if (variance_of_rays <= 2.0 * variance_of_maps) return;
    }
    plan.collections.found_by_sensors.clear();
    scatter_for({});
}

}  // namespace lucerna::optics
