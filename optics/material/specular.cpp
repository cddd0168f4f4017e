// Mirror, smooth metal and smooth boundary between media.
#include <cmath>

#include "optics/material/fresnel.h"
#include "optics/material/models.h"

namespace lucerna::optics {

namespace {

BsdfSample mirrored(const Vec3& wo, const Lanes& weight) {
    BsdfSample event;
    event.wi = Vec3(-wo.x(), -wo.y(), wo.z());
    event.weight = weight;
    event.specular = true;
    return event;
}

}  // namespace

std::optional<BsdfSample> sample(const Mirror& mirror, const SurfaceOptics& at, const Vec3& wo,
                                 const EventNumbers&, Transport) {
    const Lanes& reflectance = at.spectra[mirror.reflectance];
    if (!(live_mean(reflectance, at) > 0.0)) return std::nullopt;
    // As a perfect metal: both polarisations alike, r_p = -r_s.
    if (at.polarisation) at.polarisation->go_through(Mueller<double>{1.0, 0.0, -1.0, 0.0});
    return mirrored(wo, reflectance);
}

std::optional<BsdfSample> sample(const SmoothConductor& metal, const SurfaceOptics& at,
                                 const Vec3& wo, const EventNumbers&, Transport) {
    const Lanes& outside = wo.z() >= 0.0 ? at.index_above : at.index_below;
    const Lanes n = at.spectra[metal.n] / outside;
    const Lanes k = at.spectra[metal.k] / outside;
    if (!at.polarisation) return mirrored(wo, fresnel_conductor(std::abs(wo.z()), n, k));
    const Mueller<Lanes> reflection = conductor_reflection(std::abs(wo.z()), n, k);
    const Lanes reflectance = at.polarisation->flux_factor(reflection);
    at.polarisation->go_through(reflection);
    return mirrored(wo, reflectance);
}

std::optional<BsdfSample> sample(const SmoothDielectric&, const SurfaceOptics& at, const Vec3& wo,
                                 const EventNumbers& u, Transport transport) {
    const bool above = wo.z() >= 0.0;
    const Lanes& index_wo = above ? at.index_above : at.index_below;
    const Lanes& index_wi = above ? at.index_below : at.index_above;
    const int hero = at.hero;
    const double hero_eta =
        static_cast<double>(index_wi[hero]) / static_cast<double>(index_wo[hero]);
    const double cos_o = std::abs(wo.z());

    // Lanes that leave in the hero's direction, and the hero's multiple, so that the mean over
    // heroes (uniform) is the sum over all lanes. Under total reflection of the hero only, the
    // lanes that would be transmitted have their share in the phases where they are the hero.
    const bool splits = at.dispersive && !at.hero_only;
    Polarisation* light = at.polarisation;
    Mueller<double> hero_reflection{};
    Mueller<Lanes> reflection;
    Lanes reflectance;
    if (light) {
        hero_reflection = dielectric_reflection(cos_o, hero_eta);
        reflectance = light->flux_factor(hero_reflection);
        if (splits) {
            const float of_hero = reflectance[hero];
            reflection = dielectric_reflection(cos_o, index_wi / index_wo);
            reflectance = light->flux_factor(reflection);
            reflectance[hero] = of_hero;
        }
    } else {
        const double of_hero = fresnel_dielectric(cos_o, hero_eta).unpolarised();
        reflectance.setConstant(static_cast<float>(of_hero));
        if (splits) {
            reflectance = fresnel_dielectric(cos_o, index_wi / index_wo);
            reflectance[hero] = static_cast<float>(of_hero);
        }
    }
    // In proportion to what each choice carries: the mean weight is the same for both.
    const double mean_reflectance =
        splits ? static_cast<double>(reflectance.mean()) : live_mean(reflectance, at);
    const double transmittance =
        1.0 - (splits ? static_cast<double>(reflectance[hero]) : mean_reflectance);
    const double p_reflect = mean_reflectance / (mean_reflectance + transmittance);
    if (u.lobe < p_reflect) {
        if (light && splits) light->go_through(reflection);
        if (light && !splits) light->go_through(hero_reflection);
        BsdfSample event = mirrored(wo, reflectance * static_cast<float>(1.0 / p_reflect));
        event.probability = p_reflect;
        return event;
    }
    if (light) light->go_through(refraction(hero_reflection));
    const double p_refract = 1.0 - p_reflect;
    BsdfSample event;
    event.probability = p_refract;
    event.wi = refract(wo, z_axis(above ? 1.0 : -1.0), hero_eta);
    event.specular = true;
    event.hero_only = splits;
    event.weight = (1.0f - reflectance) * static_cast<float>(1.0 / p_refract);
    if (splits) {
        const float of_hero = event.weight[hero] * static_cast<float>(spectral::lane_count);
        event.weight.setZero();
        event.weight[hero] = of_hero;
    }
    if (transport == Transport::radiance) event.weight *= (index_wo / index_wi).square();
    return event;
}

}  // namespace lucerna::optics
