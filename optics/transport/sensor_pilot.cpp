#include "optics/transport/sensor_pilot.h"

#include <algorithm>

#include "optics/transport/arrival_density.h"

namespace lucerna::optics {
namespace {

constexpr std::uint32_t rays_to_guide = 1 << 16;
constexpr std::uint32_t phases_to_compare = 4;
// Rays of a sensor per one that finds a light: one that is seldom found is better gathered, as each
// ray that does find it weighs much, and a few pilot phases do not tell how much.
constexpr std::uint64_t most_rays_per_find = 64;

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
    std::vector<Quantity> quantities;                      // in the order of the bins of sensors
    std::vector<std::vector<std::uint64_t>> lights_found;  // [observer][light]
};

PilotReadings read(const Phase& first, const TraceContext& context, const Plan& plan) {
    Plan pilot = plan;
    pilot.collections.sensors.second_direct = false;
    pilot.collections.sensors.second_deposit = 0;
    pilot.secondary_rays = forward_rays_per_block;
    std::vector<BinBlock> blocks;
    for (const BinBlock& block : plan.rays.blocks()) {
        if (!is_camera(context.stage.parts(), context.readings.observers()[block.observer_bins])) {
            blocks.push_back(block);
        }
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

// Sums over some readings of the relative variances of both.
std::array<double, 2> variances(const PilotReadings& one, const PilotReadings& other,
                                std::size_t first, std::size_t count) {
    std::array<double, 2> sums{};
    for (std::size_t i = first; i < first + count; ++i) {
        const Estimate& a = one.quantities[i].estimate;
        const Estimate& b = other.quantities[i].estimate;
        const double value_square = square(0.5 * (a.mean() + b.mean()));
        if (!(value_square > 0.0)) continue;
        sums[0] += square(a.standard_error()) / value_square;
        sums[1] += square(b.standard_error()) / value_square;
    }
    return sums;
}

}  // namespace

void prepare_sensors(const Phase& first, const TraceContext& context, const Settings& settings,
                     Plan& plan) {
    const Stage& stage = context.stage;
    const auto& observers = context.readings.observers();
    std::vector<std::size_t> sensors;
    for (std::size_t i = 0; i < observers.size(); ++i) {
        if (!is_camera(stage.parts(), observers[i])) sensors.push_back(i);
    }
    const Collection& collection = plan.collections.sensors;
    if (sensors.empty() || !collection.reaches_second_event()) return;

    ForwardTally unused(stage.parts());
    const std::uint8_t histories = mask(History::indirect) | mask(History::caustic);
    const PilotPhotons photons{trace_photons(first, context, Emission(first, RandomPurpose::pilot),
                                             Reach::whole_path, histories, rays_to_guide, unused),
                               rays_to_guide, first.wavelengths.luminance};
    const SeenPoints seen = seen_points(first, context, settings);
    const auto scatter = [&] { scatter_to_arrivals(first, context, seen, photons, plan.rays); };
    const std::vector<bool> lights = lights_with_surface(stage);
    if (!plan.gathers(stage, context.planes, History::caustic) || !collection.second_direct ||
        std::ranges::find(lights, true) == lights.end()) {
        return scatter();
    }
    const PilotReadings by_maps = read(first, context, plan);
    for (const std::size_t i : sensors) plan.rays.look_for(i, lights);
    scatter();
    PilotReadings by_rays = read(first, context, plan);
    // Without the lights that are seldom found.
    bool all_are_found = true;
    for (const std::size_t i : sensors) {
        std::uint64_t rays = 0;
        for (std::size_t bin = 0; bin < observers[i].count; ++bin) {
            rays += phases_to_compare * plan.rays.of(i, bin).count;
        }
        std::vector<bool> often = lights;
        for (std::size_t light = 0; light < lights.size(); ++light) {
            if (most_rays_per_find * by_rays.lights_found[i][light] < rays) {
                often[light] = false;
            }
        }
        if (often == lights) continue;
        all_are_found = false;
        plan.rays.look_for(
            i, std::ranges::find(often, true) == often.end() ? std::vector<bool>{} : often);
    }
    if (!all_are_found) {
        scatter();
        by_rays = read(first, context, plan);
    }
    std::size_t first_reading = 0;
    for (const std::size_t i : sensors) {
        const auto [of_maps, of_rays] =
            variances(by_maps, by_rays, first_reading, observers[i].count);
        if (of_rays > 2.0 * of_maps) plan.rays.look_for(i, {});
        first_reading += observers[i].count;
    }
    scatter();
}

}  // namespace lucerna::optics
