#include "optics/transport/direct_light.h"

namespace lucerna::optics {
namespace {

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
    Path line{.ray = {from, light.direction},
              .start = surface ? *surface : SurfacePoint{},
              .media = std::move(media),
              .weight = Lanes::Ones(),
              .hero_only = false,
              .hero = phase.wavelengths.hero,
              .lossless_events = 0};
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
    const Stage& stage = phase.stage;
    const double by_light =
        stage.light_choice().probability(light) *
        illuminate_pdf_solid_angle(stage.parts().lights[light].source, x, emitter);
    return balance_weight(pdf_solid_angle, by_light);
}

Lanes light_sample(const Phase& phase, const GatherPoint& at, const SurfacePoint* surface,
                   const MediumStack& media_above, const MediumStack& media_below,
                   RandomStream& random, std::uint64_t& shadow_segments) {
    const Stage& stage = phase.stage;
    const std::size_t chosen = stage.light_choice().sample(random.uniform());
    const double u1 = random.uniform();
    const double u2 = random.uniform();
    const Light& light = stage.parts().lights[chosen];
    const auto sampled = illuminate(light.source, at.point.position, u1, u2);
    if (!sampled || !(sampled->factor > 0.0)) return Lanes::Zero();

    const Vec3 wi = at.frame.to_local(sampled->direction);
    const Lanes f = evaluate(at.bsdf, at.optics, at.wo, wi, Transport::radiance);
    if (!(f.maxCoeff() > 0.0f)) return Lanes::Zero();
    const auto seen = line_of_sight(phase, at.point.position, surface, *sampled,
                                    wi.z() > 0.0 ? media_above : media_below, shadow_segments);
    if (!seen) return Lanes::Zero();

    const double probability = stage.light_choice().probability(chosen);
    const double by_bsdf =
        sampled->delta ? 0.0 : pdf_solid_angle(at.bsdf, at.optics, at.wo, wi, Transport::radiance);
    const double weight =
        sampled->delta ? 1.0 : balance_weight(probability * sampled->pdf_solid_angle, by_bsdf);
    return f * *seen * phase.spectra[light.flux_w_per_nm] *
           static_cast<float>(std::abs(wi.z()) * sampled->factor * weight / probability);
}

}  // namespace lucerna::optics
