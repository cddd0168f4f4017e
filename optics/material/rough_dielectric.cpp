// Rough boundary between two media: single scattering by GGX facets (Walter et al. 2007). Light
// that would meet a second facet counts as absorbed.
//
// Where the index differs between lanes, each lane has its own half vector of refraction. A sample
// follows one live lane, chosen with equal probability, and is weighted by the density of all of
// them together (one-sample balance heuristic), so that every lane is unbiased and none ends here.
#include <algorithm>
#include <cmath>

#include "optics/material/fresnel.h"
#include "optics/material/ggx.h"
#include "optics/material/models.h"

namespace lucerna::optics {

namespace {

/// One wavelength's view of the boundary, turned so that wo is above it.
struct RoughBoundary {
    Ggx facets;
    double index_wo, index_wi;  ///< on the side of wo, and on the other

    double eta() const { return index_wi / index_wo; }
    double reflectance(double cos_o) const {
        return fresnel_dielectric(cos_o, eta()).unpolarised();
    }

    /// Normal of the facet that refracts wo into wi; nothing if there is none.
    std::optional<Vec3> refracting_facet(const Vec3& wo, const Vec3& wi) const {
        if (eta() == 1.0) return std::nullopt;
        Vec3 m = (index_wo * wo + index_wi * wi).normalized();  // Walter 2007, eq. 16
        if (m.z() < 0.0) m = -m;
        if (!(wo.dot(m) > 0.0 && wi.dot(m) < 0.0)) return std::nullopt;
        return m;
    }

    /// d m / d wi of refraction, Walter 2007, eq. 17.
    double refraction_jacobian(const Vec3& wo, const Vec3& wi, const Vec3& m) const {
        const double sum = index_wo * wo.dot(m) + index_wi * wi.dot(m);
        return index_wi * index_wi * std::abs(wi.dot(m)) / (sum * sum);
    }

    /// Flux transport: f [1/sr] without the radiance factor.
    double f(const Vec3& wo, const Vec3& wi) const {
        if (wi.z() > 0.0) {
            const Vec3 m = (wo + wi).normalized();
            return reflectance(std::min(1.0, wo.dot(m))) * facets.facet_density(m) *
                   facets.visible_share_same_side(wo, wi) / (4.0 * wo.z() * wi.z());
        }
        const std::optional<Vec3> m = refracting_facet(wo, wi);
        if (!m) return 0.0;
        const double cos_o = wo.dot(*m);
        // Walter 2007, eq. 21
        return (1.0 - reflectance(cos_o)) * cos_o * refraction_jacobian(wo, wi, *m) *
               facets.facet_density(*m) * facets.visible_share_opposite_sides(wo, wi) /
               (wo.z() * std::abs(wi.z()));
    }

    double pdf_solid_angle(const Vec3& wo, const Vec3& wi) const {
        if (wi.z() > 0.0) {
            const Vec3 m = (wo + wi).normalized();
            const double cos_o = std::min(1.0, wo.dot(m));
            return reflectance(cos_o) * facets.visible_density(wo, m) / (4.0 * cos_o);
        }
        const std::optional<Vec3> m = refracting_facet(wo, wi);
        if (!m) return 0.0;
        return (1.0 - reflectance(wo.dot(*m))) * facets.visible_density(wo, *m) *
               refraction_jacobian(wo, wi, *m);
    }
};

/// The boundary as seen from wo, and the lanes that need a look of their own.
class LaneBoundaries {
public:
    LaneBoundaries(const RoughDielectric& dielectric, const SurfaceOptics& at, const Vec3& wo)
        : flip_(wo.z() < 0.0),
          facets_(dielectric.roughness),
          index_wo_(flip_ ? at.index_below : at.index_above),
          index_wi_(flip_ ? at.index_above : at.index_below),
          each_lane_(at.dispersive && !at.hero_only),
          hero_(at.hero) {}

    Vec3 turned(const Vec3& v) const { return flip_ ? Vec3(v.x(), v.y(), -v.z()) : v; }

    /// Boundaries that differ: every lane's, or the hero's, which stands for all.
    int count() const { return each_lane_ ? spectral::lane_count : 1; }
    RoughBoundary boundary(int number) const {
        const int lane = each_lane_ ? number : hero_;
        return {facets_, static_cast<double>(index_wo_[lane]),
                static_cast<double>(index_wi_[lane])};
    }
    /// Value of a function of the boundary on every lane.
    template <typename Function>
    Lanes on_lanes(Function value) const {
        if (!each_lane_) return Lanes::Constant(static_cast<float>(value(boundary(0))));
        Lanes result;
        for (int k = 0; k < count(); ++k) result[k] = static_cast<float>(value(boundary(k)));
        return result;
    }
    double pdf_solid_angle(const Vec3& wo, const Vec3& wi) const {
        double sum = 0.0;
        for (int k = 0; k < count(); ++k) sum += boundary(k).pdf_solid_angle(wo, wi);
        return sum / count();
    }
    /// f as the transport asks for it.
    Lanes f(const Vec3& wo, const Vec3& wi, Transport transport) const {
        Lanes value = on_lanes([&](const RoughBoundary& b) { return b.f(wo, wi); });
        if (wi.z() < 0.0 && transport == Transport::radiance) value *= radiance_factor();
        return value;
    }
    Lanes radiance_factor() const { return (index_wo_ / index_wi_).square(); }

private:
    bool flip_;
    Ggx facets_;
    const Lanes& index_wo_;
    const Lanes& index_wi_;
    bool each_lane_;
    int hero_;
};

/// Without a difference of index the boundary does not exist: light goes straight on, on those
/// lanes.
BsdfSample straight_on(const LaneBoundaries& lanes, const Vec3& wo) {
    BsdfSample event;
    event.wi = -wo;
    event.specular = true;
    event.weight =
        lanes.on_lanes([](const RoughBoundary& b) { return b.eta() == 1.0 ? 1.0 : 0.0; });
    event.weight /= event.weight.mean();  // probability of choosing one of them
    return event;
}

}  // namespace

Lanes evaluate(const RoughDielectric& dielectric, const SurfaceOptics& at, const Vec3& wo,
               const Vec3& wi, Transport transport) {
    if (wo.z() == 0.0 || wi.z() == 0.0) return Lanes::Zero();
    const LaneBoundaries lanes(dielectric, at, wo);
    return lanes.f(lanes.turned(wo), lanes.turned(wi), transport);
}

double pdf_solid_angle(const RoughDielectric& dielectric, const SurfaceOptics& at, const Vec3& wo,
                       const Vec3& wi, Transport) {
    if (wo.z() == 0.0 || wi.z() == 0.0) return 0.0;
    const LaneBoundaries lanes(dielectric, at, wo);
    return lanes.pdf_solid_angle(lanes.turned(wo), lanes.turned(wi));
}

std::optional<BsdfSample> sample(const RoughDielectric& dielectric, const SurfaceOptics& at,
                                 const Vec3& wo_, const EventNumbers& u, Transport transport) {
    if (wo_.z() == 0.0) return std::nullopt;
    const LaneBoundaries lanes(dielectric, at, wo_);
    const Vec3 wo = lanes.turned(wo_);
    const int chosen = std::min(lanes.count() - 1, static_cast<int>(u.lobe * lanes.count()));
    const double u_lobe = u.lobe * lanes.count() - chosen;
    const RoughBoundary boundary = lanes.boundary(chosen);
    if (boundary.eta() == 1.0) return straight_on(lanes, wo_);

    const Vec3 m = boundary.facets.sample_visible(wo, u.u1, u.u2);
    const bool reflects = u_lobe < boundary.reflectance(std::clamp(wo.dot(m), 0.0, 1.0));
    const Vec3 wi = reflects ? reflect(wo, m) : refract(wo, m, boundary.eta());
    if (wi.z() == 0.0 || (wi.z() > 0.0) != reflects) return std::nullopt;  // meets a second facet
    BsdfSample event;
    event.wi = lanes.turned(wi);
    event.pdf_solid_angle = lanes.pdf_solid_angle(wo, wi);
    if (!(event.pdf_solid_angle > 0.0)) return std::nullopt;  // underflow at extreme grazing
    event.weight =
        lanes.f(wo, wi, transport) * static_cast<float>(std::abs(wi.z()) / event.pdf_solid_angle);
    return event;
}

}  // namespace lucerna::optics
