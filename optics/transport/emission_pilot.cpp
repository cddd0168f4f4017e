#include "optics/transport/emission_pilot.h"

#include <algorithm>

#include "core/parallel.h"

namespace lucerna::optics {
namespace {

constexpr std::uint32_t pilot_rays = 1 << 16;
constexpr std::uint32_t rays_per_task = 1 << 10;
constexpr std::size_t photons_per_task = 1 << 9;
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
            stored[block] = trace_backward(phase, {to_first_event, to_first_event}, observers[i],
                                           rays, blocks[spread_out(block, count, blocks.size())],
                                           context.planes, no_maps, unused, tally);
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
        const Vec3& normal = context.planes.normal_of(plane);
        for (const SensorPlanes::Point& point : context.planes.points_of(plane)) {
            seen.vertices.push_back({.point = {point.position, normal, no_object, plane, plane},
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
    using Found = BackwardMap::Deposits;
    // Calls use(vertex, number of the photon, its flux as the vertex passes it on).
    const auto for_each_found = [&](const Found& found, std::size_t part, const auto& use) {
        for (const auto& [number, of_photon] : found.by_part[part]) {
            const BackwardPhoton& vertex = seen.vertices[number];
            const Photon& photon = found.photons[of_photon];
            // The map knows one radius for all points of a plane.
            const bool within =
                vertex.point.object != no_object ||
                (photon.point.position - vertex.point.position).norm() < radii.of_point(vertex.bin);
            if (!within) continue;
            use(number, of_photon,
                throughputs[number] * luminous_flux(phase.wavelengths.luminance, photon));
        }
    };

    std::vector<double> light(throughputs.size());  // that each vertex finds
    std::vector<Found> found((photons.photons.size() + photons_per_task - 1) / photons_per_task);
    for_each_block(found.size(), context.threads, [&](std::size_t task) {
        const std::size_t end = std::min(photons.photons.size(), (task + 1) * photons_per_task);
        for (std::size_t i = task * photons_per_task; i < end; ++i) {
            map.find(photons.photons[i], found[task]);
        }
    });
    for_each_block(BackwardMap::parts, context.threads, [&](std::size_t part) {
        for (const Found& of_task : found) {
            for_each_found(of_task, part, [&](std::uint32_t vertex, std::uint32_t, double flux_lm) {
                light[vertex] += flux_lm;
            });
        }
    });
    std::vector<double> squares(seen.target_count());  // what a variance is compared with
    for (std::size_t i = 0; i < light.size(); ++i) squares[seen.targets[i]] += light[i] * light[i];

    const Emission emission(phase, RandomPurpose::emission);
    std::vector<RayOfUse> rays(pilot_rays);
    for_each_block(pilot_rays / rays_per_task, context.threads, [&](std::size_t task) {
        ForwardTally unused(context.stage.parts());
        const auto first = static_cast<std::uint32_t>(task) * rays_per_task;
        Found by_rays;
        std::vector<std::uint32_t> ray_of_photon;
        for (std::uint32_t i = first; i < first + rays_per_task; ++i) {
            RandomStream random = emission.random(i);
            rays[i].departure = emission.depart(i, random);
            trace_forward(phase, emission, i, Reach::first_scattering, &context.planes, unused,
                          [&](const Photon& photon) {
                              if (photon.history != History::caustic) return;
                              map.find(photon, by_rays);
                              ray_of_photon.resize(by_rays.photons.size(), i);
                          });
        }
        for (std::size_t part = 0; part < BackwardMap::parts; ++part) {
            for_each_found(
                by_rays, part, [&](std::uint32_t vertex, std::uint32_t photon, double flux_lm) {
                    const double square_of_all = squares[seen.targets[vertex]];
                    if (square_of_all > 0.0) {
                        rays[ray_of_photon[photon]].use += square(flux_lm) / square_of_all;
                    }
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
