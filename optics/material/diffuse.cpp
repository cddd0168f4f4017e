// Lambertian reflection and transmission.
#include <cmath>

#include "core/sampling.h"
#include "optics/material/models.h"

namespace lucerna::optics {

namespace {

bool same_side(const Vec3& a, const Vec3& b) {
    return std::signbit(a.z()) == std::signbit(b.z());
}

/// Probability of reflection, in proportion to the reflected share of the scattered light; 0 with
/// `albedo` 0 if nothing is scattered.
double reflection_probability(const Diffuse& diffuse, const SurfaceOptics& at, double& albedo) {
    const double reflected = live_mean(at.spectra[diffuse.reflectance], at);
    albedo = reflected + live_mean(at.spectra[diffuse.transmittance], at);
    return albedo > 0.0 ? reflected / albedo : 0.0;
}

}  // namespace

Lanes evaluate(const Diffuse& diffuse, const SurfaceOptics& at, const Vec3& wo, const Vec3& wi,
               Transport) {
    return at.spectra[same_side(wo, wi) ? diffuse.reflectance : diffuse.transmittance] *
           static_cast<float>(1.0 / pi);
}

double pdf_solid_angle(const Diffuse& diffuse, const SurfaceOptics& at, const Vec3& wo,
                       const Vec3& wi, Transport) {
    double albedo;
    const double p_reflect = reflection_probability(diffuse, at, albedo);
    if (!(albedo > 0.0)) return 0.0;
    return (same_side(wo, wi) ? p_reflect : 1.0 - p_reflect) * std::abs(wi.z()) / pi;
}

double reflection_probability(const Diffuse& diffuse, const SurfaceOptics& at) {
    double albedo;
    const double p_reflect = reflection_probability(diffuse, at, albedo);
    return albedo > 0.0 ? p_reflect : 1.0;
}

std::optional<BsdfSample> sample(const Diffuse& diffuse, const SurfaceOptics& at, const Vec3& wo,
                                 const EventNumbers& u, Transport) {
    double albedo;
    const double p_reflect = reflection_probability(diffuse, at, albedo);
    if (!(albedo > 0.0)) return std::nullopt;
    const bool reflects = u.lobe < p_reflect;
    const double probability = reflects ? p_reflect : 1.0 - p_reflect;

    BsdfSample event;
    event.wi = sample_cosine_hemisphere(u.u1, u.u2);
    if (reflects == std::signbit(wo.z())) event.wi.z() = -event.wi.z();
    event.weight = at.spectra[reflects ? diffuse.reflectance : diffuse.transmittance] *
                   static_cast<float>(1.0 / probability);
    event.pdf_solid_angle = probability * std::abs(event.wi.z()) / pi;
    return event;
}

}  // namespace lucerna::optics
