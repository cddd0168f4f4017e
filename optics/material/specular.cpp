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
    return mirrored(wo, reflectance);
}

std::optional<BsdfSample> sample(const SmoothConductor& metal, const SurfaceOptics& at,
                                 const Vec3& wo, const EventNumbers&, Transport) {
    const Lanes& outside = wo.z() >= 0.0 ? at.index_above : at.index_below;
    return mirrored(wo, fresnel_conductor(std::abs(wo.z()), at.spectra[metal.n] / outside,
                                          at.spectra[metal.k] / outside));
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
    const double hero_reflectance = fresnel_dielectric(cos_o, hero_eta).unpolarised();

    // Lanes that leave in the hero's direction, and the hero's multiple, so that the mean over
    // heroes (uniform) is the sum over all lanes. Under total reflection of the hero only, the
    // lanes that would be transmitted have their share in the phases where they are the hero.
    const bool splits = at.dispersive && !at.hero_only;
    Lanes reflectance = Lanes::Constant(static_cast<float>(hero_reflectance));
    double mean_reflectance = hero_reflectance;
    if (splits) {
        reflectance = fresnel_dielectric(cos_o, index_wi / index_wo);
        reflectance[hero] = static_cast<float>(hero_reflectance);
        mean_reflectance = static_cast<double>(reflectance.mean());
    }
    const double hero_transmittance = 1.0 - hero_reflectance;
    // In proportion to what each choice carries: the mean weight is the same for both.
    const double carried = mean_reflectance + hero_transmittance;
    const double p_reflect = mean_reflectance / carried;
    if (u.lobe < p_reflect) {
        BsdfSample event = mirrored(wo, reflectance * static_cast<float>(1.0 / p_reflect));
        event.probability = p_reflect;
        return event;
    }
    BsdfSample event;
    event.probability = 1.0 - p_reflect;
    event.wi = refract(wo, z_axis(above ? 1.0 : -1.0), hero_eta);
    event.specular = true;
    event.hero_only = splits;
    // carried = transmittance / (1 - p_reflect)
    if (splits) {
        event.weight.setZero();
        event.weight[hero] = static_cast<float>(carried * spectral::lane_count);
    } else {
        event.weight.setConstant(static_cast<float>(carried));
    }
    if (transport == Transport::radiance) event.weight *= (index_wo / index_wi).square();
    return event;
}

}  // namespace lucerna::optics
