#include "optics/transport/direct_light.h"

#include <algorithm>
#include <array>
#include <memory>

namespace lucerna::optics {
namespace {

// All lights are drawn once each if they are few; of many, this number by their flux.
constexpr std::size_t max_light_draws = 8;
// A light that brings less than this share of the unshadowed sum gets its shadow ray by roulette.
constexpr double roulette_share = 0.1;

// Expected number of samples of a light per call of direct_light().
double expected_samples(const Stage& stage, std::size_t light) {
    if (stage.parts().lights.size() <= max_light_draws) return 1.0;
    return static_cast<double>(max_light_draws) * stage.light_choice().probability(light);
}

// Internal transmittance of the straight line between two points; nothing if it is blocked.
std::optional<Lanes> line_of_sight(const Phase& phase, const Vec3& from,
                                   const SurfacePoint* surface, const Illumination& light,
                                   MediumStack media, std::uint64_t& shadow_segments) {
    const Stage& stage = phase.stage;
    const SceneParts& parts = stage.parts();
    const SurfacePoint* target = light.surface.object == no_object ? nullptr : &light.surface;
    const double length_m = (light.position - from).norm();
    if (!stage.has_null_surfaces()) {
        ++shadow_segments;
        if (phase.ray_log) phase.ray_log->push_back({from, light.direction});
        if (stage.caster().occluded(from, surface, light.position, target)) return std::nullopt;
        return phase.transmittance(media.acting(parts), length_m);
    }
    // Surfaces that do not act on light are passed one by one.
    Path line;
    line.ray = {from, light.direction};
    if (surface) line.start = *surface;
    line.media = media;
    line.weight = Lanes::Ones();
    while (true) {
        ++shadow_segments;
        const double rest_m = (light.position - line.ray.origin).norm();
        const auto encounter = next_encounter(phase, line);
        const double step_m =
            encounter ? (encounter->point.position - line.ray.origin).norm() : infinity;
        const bool arrived =
            step_m >= rest_m * (1.0 - 1e-9) - stage.nudge_m() ||
            (target && encounter->point.object == target->object &&
             (encounter->point.position - target->position).norm() <= 2.0 * stage.nudge_m());
        if (arrived) {
            return line.weight * phase.transmittance(line.media.acting(parts), rest_m);
        }
        if (encounter->bsdf != pass_through || !encounter->consistent) return std::nullopt;
        line.weight *= encounter->transmittance;
        pass(line, *encounter);
    }
}

}  // namespace

Lanes emitted_radiance(const Phase& phase, std::uint32_t light, const SurfacePoint& point,
                       const Vec3& direction) {
    const Light& source = phase.stage.parts().lights[light];
    const double factor = radiance_factor(source.source, point, direction);
    if (!(factor > 0.0)) return Lanes::Zero();
    return phase.spectra[source.flux_w_per_nm] * static_cast<float>(factor);
}

double emission_weight(const Phase& phase, std::uint32_t light, const Vec3& x,
                       const SurfacePoint& emitter, double pdf_solid_angle) {
    const double by_light =
        expected_samples(phase.stage, light) *
        illuminate_pdf_solid_angle(phase.stage.parts().lights[light].source, x, emitter);
    return power_weight(pdf_solid_angle, by_light);
}

bool lights_suffice(const Stage& stage, const Bsdf& bsdf, const Vec3& x) {
    constexpr double far = 3.0;  // from its centre, in radii of a sphere around the light
    if (!std::holds_alternative<Diffuse>(bsdf)) return false;
    if (stage.parts().lights.size() > max_light_draws) return false;
    return std::ranges::all_of(stage.unevenly_sampled(), [&](const Sphere& light) {
        return (x - light.centre).squaredNorm() > square(far * light.radius_m);
    });
}

Lanes direct_light(const Phase& phase, const GatherPoint& at, const SurfacePoint* surface,
                   const MediumStack& media_above, const MediumStack& media_below,
                   LightSamples samples, const EventSplit& split, ShadowRays shadow_rays,
                   StratifiedStream& random, std::uint64_t& shadow_segments) {
    const Stage& stage = phase.stage;
    const std::size_t lights = stage.parts().lights.size();
    const std::size_t draws = std::min(lights, max_light_draws);
    // What each drawn light would bring if nothing stood in its way.
    struct Candidate {
        Illumination light;
        Lanes radiance;
        double luminance;
        bool above;
    };
    // Not initialised: that would take longer than what is done with a light.
    union Slot {
        Slot() {}
        Candidate value;
    };
    std::array<Slot, max_light_draws> candidates;
    std::size_t found = 0;
    double total = 0.0;
    for (std::size_t draw = 0; draw < draws; ++draw) {
        const std::size_t chosen =
            lights <= max_light_draws ? draw : stage.light_choice().sample(random.uniform());
        const auto [u1, u2] = random.pair();
        const Light& light = stage.parts().lights[chosen];
        const auto sampled = illuminate(light.source, at.point.position, u1, u2);
        if (!sampled || !(sampled->factor > 0.0)) continue;
        const Vec3 wi = at.frame.to_local(sampled->direction);
        const Lanes f = evaluate(at.bsdf, at.optics, at.wo, wi, Transport::radiance);
        if (!(f.maxCoeff() > 0.0f)) continue;
        const double expected = expected_samples(stage, chosen);
        double weight = 1.0;
        if (samples == LightSamples::weighed && !sampled->delta) {
            double by_bsdf = pdf_solid_angle(at.bsdf, at.optics, at.wo, wi, Transport::radiance);
            if (split.has_both()) by_bsdf /= split.probability_of(at.wo, wi);
            weight = power_weight(expected * sampled->pdf_solid_angle, by_bsdf);
        }
        const Lanes radiance =
            f * phase.spectra[light.flux_w_per_nm] *
            static_cast<float>(std::abs(wi.z()) * sampled->factor * weight / expected);
        const Candidate& candidate = *std::construct_at(
            &candidates[found++].value, *sampled, radiance, phase.luminous(radiance), wi.z() > 0.0);
        total += candidate.luminance;
    }
    Lanes sum = Lanes::Zero();
    const auto test = [&](const Candidate& candidate, double probability) {
        const auto seen =
            line_of_sight(phase, at.point.position, surface, candidate.light,
                          candidate.above ? media_above : media_below, shadow_segments);
        if (seen) sum += candidate.radiance * *seen / static_cast<float>(probability);
    };
    if (!(total > 0.0)) return sum;
    if (shadow_rays == ShadowRays::of_one && found > 1) {
        double rest = random.uniform() * total;
        std::size_t chosen = 0;
        while (chosen + 1 < found && rest >= candidates[chosen].value.luminance) {
            rest -= candidates[chosen++].value.luminance;
        }
        test(candidates[chosen].value, candidates[chosen].value.luminance / total);
        return sum;
    }
    for (std::size_t i = 0; i < found; ++i) {
        // Shadow rays for what matters; the rest by roulette.
        const Candidate& candidate = candidates[i].value;
        const double tested = std::min(1.0, candidate.luminance / (roulette_share * total));
        if (random.uniform() < tested) test(candidate, tested);
    }
    return sum;
}

}  // namespace lucerna::optics
