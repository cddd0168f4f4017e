#include "optics/transport/emission_pilot.h"

#include <algorithm>

#include "core/parallel.h"

namespace lucerna::optics {
namespace {

constexpr std::uint32_t pilot_rays = 1 << 16;
constexpr std::uint32_t rays_per_task = 1 << 10;
constexpr std::uint64_t points_per_observer = 1 << 14;
constexpr std::uint8_t all_light =
    mask(History::direct) | mask(History::caustic) | mask(History::indirect);

// Where the rays of an observer meet the first scattering surface.
void add_seen(const Phase& phase, const TraceContext& context, const Settings& settings,
              SeenPoints& seen) {
    Settings one_ray = settings;
    one_ray.samples_per_pixel = 1;
    const BackwardRays rays(context.stage.parts(), context.readings, one_ray);
    constexpr Collection to_first_event{.first_deposit = all_light};
    const auto& observers = context.readings.observers();
    for (std::size_t i = 0; i < observers.size(); ++i) {
        const Observer& observer = context.stage.parts().observers[observers[i].observer];
        if (std::holds_alternative<IlluminancePoints>(observer)) continue;
        std::vector<BinBlock> blocks;
        std::uint64_t all = 0;
        for (const BinBlock& block : rays.blocks()) {
            if (block.observer_bins != i) continue;
            blocks.push_back(block);
            for (std::size_t bin = block.first; bin < block.last; ++bin) {
                all += rays.of(i, bin).count;
            }
        }
        const std::size_t step =
            std::clamp<std::uint64_t>(all / points_per_observer, 1, blocks.size());
        const std::size_t count = (blocks.size() + step - 1) / step;
        std::vector<std::vector<BackwardPhoton>> stored(count);
        PhaseReadings unused = context.readings.new_phase();
        const ForwardMaps no_maps;
        for_each_block(count, context.threads, [&](std::size_t block) {
            BackwardTally tally;
            stored[block] =
                trace_backward(phase, {to_first_event, to_first_event}, observers[i], rays,
                               blocks[block * step], context.planes, no_maps, unused, tally);
        });
        for (const auto& block : stored) {
            seen.vertices.insert(seen.vertices.end(), block.begin(), block.end());
        }
        seen.targets.resize(seen.vertices.size(), seen.target_count());
        seen.of_images.push_back(std::holds_alternative<Camera>(observer));
    }
}

void add_illuminance_points(const TraceContext& context, SeenPoints& seen) {
    for (std::uint32_t plane = 0; plane < context.planes.count(); ++plane) {
        for (const SensorPlanes::Point& point : context.planes.points_of(plane)) {
            seen.vertices.push_back(
                {.point = {point.position, Vec3::UnitZ(), no_object, plane, plane},
                 .wo = Vec3::UnitZ(),
                 .throughput = Lanes::Ones(),
                 .bsdf = context.stage.white_diffuser(),
                 .medium_above = no_object,
                 .medium_below = no_object,
                 .bin = point.index,
                 .accepts = all_light,
                 .hero_only = false,
                 .hero = 0});
            seen.targets.push_back(seen.target_count());
            seen.of_images.push_back(false);
        }
    }
}

}  // namespace

SeenPoints seen_points(const Phase& phase, const TraceContext& context, const Settings& settings) {
    SeenPoints seen;
    add_seen(phase, context, settings, seen);
    add_illuminance_points(context, seen);
    return seen;
}

EmissionGuide guide_of_caustics(const Phase& phase, const TraceContext& context,
                                const SeenPoints& seen, const Radii& radii,
                                const PilotPhotons& photons) {
    std::vector<double> throughputs;
    for (const BackwardPhoton& vertex : seen.vertices) {
        throughputs.push_back(phase.luminous(vertex.throughput));
    }
    const BackwardMap map(phase, radii, {seen.vertices}, context.threads);
    const auto for_each_found = [&](const Photon& photon, const auto& use) {
        BackwardMap::Deposits found;
        map.find(photon, found);
        for (const auto& part : found.by_part) {
            for (const auto& pair : part) {
                const BackwardPhoton& vertex = seen.vertices[pair.backward_photon];
                // The map knows one radius for all points of a plane.
                const bool within = vertex.point.object != no_object ||
                                    (photon.point.position - vertex.point.position).norm() <
                                        radii.of_point(vertex.bin);
                if (within) use(pair.backward_photon);
            }
        }
    };

    std::vector<double> light(throughputs.size());  // that each vertex finds
    for (const Photon& photon : photons.photons) {
        const double flux_lm = luminous_flux(phase.wavelengths.luminance, photon);
        for_each_found(photon, [&](std::uint32_t i) { light[i] += throughputs[i] * flux_lm; });
    }
    std::vector<double> squares(seen.target_count());  // what a variance is compared with
    for (std::size_t i = 0; i < light.size(); ++i) squares[seen.targets[i]] += light[i] * light[i];

    const Emission emission(phase, RandomPurpose::emission);
    std::vector<RayOfUse> rays(pilot_rays);
    for_each_block(pilot_rays / rays_per_task, context.threads, [&](std::size_t task) {
        ForwardTally unused(context.stage.parts());
        const auto first = static_cast<std::uint32_t>(task) * rays_per_task;
        for (std::uint32_t i = first; i < first + rays_per_task; ++i) {
            RandomStream random = emission.random(i);
            rays[i].departure = emission.depart(i, random);
            trace_forward(
                phase, emission, i, Reach::first_scattering, &context.planes, unused,
                [&](const Photon& photon) {
                    if (photon.history != History::caustic) return;
                    const double flux_lm = luminous_flux(phase.wavelengths.luminance, photon);
                    for_each_found(photon, [&](std::uint32_t found) {
                        const double square_of_all = squares[seen.targets[found]];
                        if (square_of_all > 0.0) {
                            rays[i].use += square(throughputs[found] * flux_lm) / square_of_all;
                        }
                    });
                });
        }
    });
    std::vector<double> fluxes_lm;
    for (const Light& each : context.stage.parts().lights) {
        fluxes_lm.push_back(each.luminous_flux_lm);
    }
    return {fluxes_lm, rays};
}

}  // namespace lucerna::optics
