// Weighted sum of other BSDFs: one component is chosen in proportion to its weight; where
// scattering lobes overlap, the sample is weighted by the whole sum (one-sample balance heuristic).
#include <algorithm>
#include <cmath>

#include "optics/material/models.h"

namespace lucerna::optics {

namespace {

double total_weight(const Mixture& mixture) {
    double total = 0.0;
    for (const auto& component : mixture.components) total += component.weight;
    return total;
}

}  // namespace

Lanes evaluate(const Mixture& mixture, const SurfaceOptics& at, const Vec3& wo, const Vec3& wi,
               Transport transport) {
    Lanes f = Lanes::Zero();
    for (const auto& [weight, id] : mixture.components) {
        f += static_cast<float>(weight) * evaluate(at.bsdfs[id], at, wo, wi, transport);
    }
    return f;
}

double pdf_solid_angle(const Mixture& mixture, const SurfaceOptics& at, const Vec3& wo,
                       const Vec3& wi, Transport transport) {
    const double total = total_weight(mixture);
    if (!(total > 0.0)) return 0.0;
    double sum = 0.0;
    for (const auto& [weight, id] : mixture.components) {
        sum += weight * pdf_solid_angle(at.bsdfs[id], at, wo, wi, transport);
    }
    return sum / total;
}

double scattering_probability(const Mixture& mixture, const std::vector<Bsdf>& bsdfs) {
    double scattering = 0.0;
    bool specular = false;
    for (const auto& [weight, id] : mixture.components) {
        const bool scatters = has_scattering_lobe(bsdfs[id], bsdfs);
        specular = specular || has_specular_lobe(bsdfs[id], bsdfs);
        if (specular && scatters) return 1.0;
        if (!specular) scattering += weight;
    }
    return specular ? scattering / total_weight(mixture) : 1.0;
}

std::optional<BsdfSample> sample(const Mixture& mixture, const SurfaceOptics& at, const Vec3& wo,
                                 const EventNumbers& u, Transport transport) {
    const double total = total_weight(mixture);
    if (!(total > 0.0)) return std::nullopt;
    double rest = u.lobe * total;
    std::size_t chosen = 0;
    while (chosen + 1 < mixture.components.size() && rest >= mixture.components[chosen].weight) {
        rest -= mixture.components[chosen++].weight;
    }
    const auto& [weight, id] = mixture.components[chosen];
    if (!(weight > 0.0)) return std::nullopt;  // by rounding only
    const double u_lobe = std::min(rest / weight, std::nextafter(1.0, 0.0));
    std::optional<BsdfSample> event = sample(at.bsdfs[id], at, wo, u_lobe, u.u1, u.u2, transport);
    if (!event) return event;
    if (event->specular) {
        event->weight *= static_cast<float>(total);
    } else {
        event->pdf_solid_angle = pdf_solid_angle(mixture, at, wo, event->wi, transport);
        event->weight = evaluate(mixture, at, wo, event->wi, transport) *
                        static_cast<float>(std::abs(event->wi.z()) / event->pdf_solid_angle);
    }
    return event;
}

}  // namespace lucerna::optics
