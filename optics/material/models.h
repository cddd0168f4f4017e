// The models behind the closed list of bsdf.h: one overload per model of evaluate, pdf_solid_angle
// and sample, with the contracts of bsdf.h. For use inside optics/material only.
#pragma once

#include "optics/material/bsdf.h"

namespace lucerna::optics {

/// Random numbers of one event.
struct EventNumbers {
    double lobe, u1, u2;
};

/// Mean over the lanes that still count: all, or the hero's alone.
inline double live_mean(const Lanes& value, const SurfaceOptics& at) {
    return static_cast<double>(at.hero_only ? value[at.hero] : value.mean());
}

inline Vec3 z_axis(double sign) {
    return {0.0, 0.0, sign};
}

// Models with scattering lobes.
Lanes evaluate(const Diffuse&, const SurfaceOptics&, const Vec3& wo, const Vec3& wi, Transport);
double pdf_solid_angle(const Diffuse&, const SurfaceOptics&, const Vec3& wo, const Vec3& wi,
                       Transport);
std::optional<BsdfSample> sample(const Diffuse&, const SurfaceOptics&, const Vec3& wo,
                                 const EventNumbers&, Transport);

Lanes evaluate(const RoughConductor&, const SurfaceOptics&, const Vec3& wo, const Vec3& wi,
               Transport);
double pdf_solid_angle(const RoughConductor&, const SurfaceOptics&, const Vec3& wo, const Vec3& wi,
                       Transport);
std::optional<BsdfSample> sample(const RoughConductor&, const SurfaceOptics&, const Vec3& wo,
                                 const EventNumbers&, Transport);

Lanes evaluate(const RoughDielectric&, const SurfaceOptics&, const Vec3& wo, const Vec3& wi,
               Transport);
double pdf_solid_angle(const RoughDielectric&, const SurfaceOptics&, const Vec3& wo, const Vec3& wi,
                       Transport);
std::optional<BsdfSample> sample(const RoughDielectric&, const SurfaceOptics&, const Vec3& wo,
                                 const EventNumbers&, Transport);

Lanes evaluate(const Measured&, const SurfaceOptics&, const Vec3& wo, const Vec3& wi, Transport);
double pdf_solid_angle(const Measured&, const SurfaceOptics&, const Vec3& wo, const Vec3& wi,
                       Transport);
std::optional<BsdfSample> sample(const Measured&, const SurfaceOptics&, const Vec3& wo,
                                 const EventNumbers&, Transport);

Lanes evaluate(const Mixture&, const SurfaceOptics&, const Vec3& wo, const Vec3& wi, Transport);
double pdf_solid_angle(const Mixture&, const SurfaceOptics&, const Vec3& wo, const Vec3& wi,
                       Transport);
std::optional<BsdfSample> sample(const Mixture&, const SurfaceOptics&, const Vec3& wo,
                                 const EventNumbers&, Transport);

// Models that choose the kind of an event first, see event_split() of bsdf.h: probability of the
// kind that u_lobe below it stand for.
double reflection_probability(const Diffuse&, const SurfaceOptics&);
double reflection_probability(const Measured&, const Vec3& wo, Transport);
/// 1 unless all components that scatter stand before all that are specular.
double scattering_probability(const Mixture&, const std::vector<Bsdf>& bsdfs);

// Models with specular lobes only.
std::optional<BsdfSample> sample(const Mirror&, const SurfaceOptics&, const Vec3& wo,
                                 const EventNumbers&, Transport);
std::optional<BsdfSample> sample(const SmoothConductor&, const SurfaceOptics&, const Vec3& wo,
                                 const EventNumbers&, Transport);
std::optional<BsdfSample> sample(const SmoothDielectric&, const SurfaceOptics&, const Vec3& wo,
                                 const EventNumbers&, Transport);

/// True for models whose lobes are all specular, so that f and its density are 0 everywhere.
template <typename Model>
inline constexpr bool specular_only =
    std::is_same_v<Model, Black> || std::is_same_v<Model, Mirror> ||
    std::is_same_v<Model, SmoothConductor> || std::is_same_v<Model, SmoothDielectric>;

}  // namespace lucerna::optics
