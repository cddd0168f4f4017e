#include "optics/transport/forward_trace.h"

#include <algorithm>

namespace lucerna::optics {
namespace {

// Adds lists that are as long as the scene has objects.
void add(std::vector<double>& sum, const std::vector<double>& part) {
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += part[i];
}

Path emitted_path(const Phase& phase, const Departure& departure, bool common_hero,
                  RandomStream& random) {
    const Stage& stage = phase.stage;
    const Light& light = stage.parts().lights[departure.light];
    const auto& [u1, u2, u3, u4] = departure.u;
    const EmittedRay emitted = emit(light.source, u1, u2, u3, u4);
    const double scale =
        emitted.weight * departure.weight / stage.light_choice().probability(departure.light);
    const double u_hero = random.uniform();
    return {.ray = emitted.ray,
            .start = emitted.surface,
            .media = stage.media_at(emitted.ray.origin + stage.nudge_m() * emitted.ray.direction),
            .weight = phase.spectra[light.flux_w_per_nm] * static_cast<float>(scale),
            .hero_only = false,
            .hero = common_hero ? choose_common_hero(phase, u_hero) : choose_hero(u_hero),
            .lossless_events = 0};
}

}  // namespace

void ForwardTally::operator+=(const ForwardTally& other) {
    emitted += other.emitted;
    escaped += other.escaped;
    trapped += other.trapped;
    inconsistent += other.inconsistent;
    numerical += other.numerical;
    residue += other.residue;
    add(absorbed_by_object, other.absorbed_by_object);
    add(absorbed_by_solid, other.absorbed_by_solid);
    add(received_front, other.received_front);
    add(received_back, other.received_back);
    segments += other.segments;
}

void trace_forward(const Phase& phase, const Emission& emission, std::uint32_t index, Reach reach,
                   const SensorPlanes* planes, ForwardTally& tally,
                   const std::function<void(const Photon&)>& arrive) {
    const Stage& stage = phase.stage;
    const SceneParts& parts = stage.parts();
    RandomStream random = emission.random(index);
    const Departure departure = emission.depart(index, random);
    const auto light = static_cast<std::uint32_t>(departure.light);
    Path path = emitted_path(phase, departure, emission.common_heroes(), random);
    History history = History::direct;
    double flux_lm = phase.luminous(path.weight);
    tally.emitted += flux_lm;
    const auto on_common_lane = [&] { return path.hero_only && emission.common_heroes(); };

    while (true) {
        const auto encounter = next_encounter(phase, path);
        ++tally.segments;
        if (planes && history != History::direct) {
            const double length_m =
                encounter ? (encounter->point.position - path.ray.origin).norm() : infinity;
            const ObjectId medium = path.media.acting(parts);
            planes->crossings(path.ray, length_m, [&](const SurfacePoint& point) {
                const double way_m = (point.position - path.ray.origin).norm();
                arrive({point, path.ray.direction, path.weight * phase.transmittance(medium, way_m),
                        history, on_common_lane(), light});
            });
        }
        if (!encounter) {
            tally.escaped += flux_lm;
            return;
        }
        const ObjectId solid = path.media.acting(parts);
        float factor = 1.0f;
        if (phase.absorbs(solid)) {
            path.weight *= encounter->transmittance;
            const double left_lm = phase.luminous(path.weight);
            tally.absorbed_by_solid[solid] += flux_lm - left_lm;
            flux_lm = left_lm;
            factor = live_max(path, encounter->transmittance);
        }
        const ObjectId object = encounter->point.object;
        (encounter->wo.z() > 0.0 ? tally.received_front : tally.received_back)[object] += flux_lm;
        if (!encounter->consistent) {
            tally.inconsistent += flux_lm;
            return;
        }
        if (encounter->bsdf == pass_through) {
            pass(path, *encounter);
            continue;
        }
        if (stage.scatters(encounter->bsdf)) {
            arrive({encounter->point, path.ray.direction, path.weight, history, on_common_lane(),
                    light});
            // A surface with both kinds of lobes lets the path go on by the specular one.
        }
        const SurfaceOptics at = optics_at(phase, *encounter, path);
        const double u_lobe = random.uniform();
        const double u1 = random.uniform();
        const double u2 = random.uniform();
        const Bsdf& bsdf = parts.bsdfs[encounter->bsdf];
        const auto sampled = sample(bsdf, at, encounter->wo, u_lobe, u1, u2, Transport::flux);
        if (!sampled || (reach == Reach::first_scattering && !sampled->specular)) {
            tally.absorbed_by_object[object] += flux_lm;
            return;
        }
        const bool turned_hero = sampled->hero_only && !path.hero_only;
        follow(path, *encounter, *sampled);
        factor *= turned_hero ? sampled->weight[path.hero] / spectral::lane_count
                              : live_max(path, sampled->weight);
        const double scattered_lm = phase.luminous(path.weight);
        if (!std::isfinite(scattered_lm)) {
            tally.numerical += flux_lm;
            return;
        }
        // A smooth boundary takes nothing: the change is the luck of choosing lane and lobe.
        const bool lossless = std::holds_alternative<SmoothDielectric>(bsdf);
        (lossless ? tally.residue : tally.absorbed_by_object[object]) += flux_lm - scattered_lm;
        flux_lm = scattered_lm;
        if (!sampled->specular) {
            history = History::indirect;
        } else if (history == History::direct) {
            history = History::caustic;
        }

        const Fate fate = roulette(path, factor, random);
        if (fate == Fate::trapped) {
            tally.trapped += flux_lm;
            return;
        }
        if (fate == Fate::ended_by_roulette) {
            tally.residue += flux_lm;
            return;
        }
        const double scaled_lm = phase.luminous(path.weight);
        tally.residue += flux_lm - scaled_lm;
        flux_lm = scaled_lm;
    }
}

}  // namespace lucerna::optics
