// Rough metal: single scattering by GGX facets. Light that would meet a second facet counts as
// absorbed; at high roughness that is a noticeable part (tests/material/test_rough.cpp states it).
#include <cmath>

#include "optics/material/fresnel.h"
#include "optics/material/ggx.h"
#include "optics/material/models.h"

namespace lucerna::optics {

namespace {

/// The same with z upward: both sides of the surface are alike.
Vec3 flipped(const Vec3& v, bool flip) {
    return flip ? Vec3(v.x(), v.y(), -v.z()) : v;
}

}  // namespace

Lanes evaluate(const RoughConductor& metal, const SurfaceOptics& at, const Vec3& wo_,
               const Vec3& wi_, Transport) {
    const bool below = wo_.z() < 0.0;
    const Vec3 wo = flipped(wo_, below), wi = flipped(wi_, below);
    if (!(wo.z() > 0.0 && wi.z() > 0.0)) return Lanes::Zero();
    const Ggx facets(metal.roughness);
    const Vec3 m = (wo + wi).normalized();
    const Lanes& outside = below ? at.index_below : at.index_above;
    // Walter 2007, eq. 20
    const double geometry =
        facets.facet_density(m) * facets.visible_share_same_side(wo, wi) / (4.0 * wo.z() * wi.z());
    return fresnel_conductor(std::min(1.0, wo.dot(m)), at.spectra[metal.n] / outside,
                             at.spectra[metal.k] / outside) *
           static_cast<float>(geometry);
}

double pdf_solid_angle(const RoughConductor& metal, const SurfaceOptics&, const Vec3& wo_,
                       const Vec3& wi_, Transport) {
    const bool below = wo_.z() < 0.0;
    const Vec3 wo = flipped(wo_, below), wi = flipped(wi_, below);
    if (!(wo.z() > 0.0 && wi.z() > 0.0)) return 0.0;
    const Vec3 m = (wo + wi).normalized();
    // d m / d wi = 1 / (4 wo.m), Walter 2007, eq. 14
    return Ggx(metal.roughness).visible_density(wo, m) / (4.0 * wo.dot(m));
}

std::optional<BsdfSample> sample(const RoughConductor& metal, const SurfaceOptics& at,
                                 const Vec3& wo_, const EventNumbers& u, Transport transport) {
    const bool below = wo_.z() < 0.0;
    const Vec3 wo = flipped(wo_, below);
    if (!(wo.z() > 0.0)) return std::nullopt;
    const Vec3 m = Ggx(metal.roughness).sample_visible(wo, u.u1, u.u2);
    const Vec3 wi = reflect(wo, m);
    if (!(wi.z() > 0.0)) return std::nullopt;  // would meet a second facet
    BsdfSample event;
    event.wi = flipped(wi, below);
    event.pdf_solid_angle = pdf_solid_angle(metal, at, wo_, event.wi, transport);
    if (!(event.pdf_solid_angle > 0.0)) return std::nullopt;  // underflow at extreme grazing
    event.weight = evaluate(metal, at, wo_, event.wi, transport) *
                   static_cast<float>(wi.z() / event.pdf_solid_angle);
    return event;
}

}  // namespace lucerna::optics
