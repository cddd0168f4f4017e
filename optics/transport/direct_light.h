// Direct light at a scattering surface by multiple importance sampling (docs/method.md eq. 4).
#pragma once

#include "optics/transport/forward_map.h"

namespace lucerna::optics {

/// Weight of a sample from one of two densities, power heuristic (Veach 1997, eq. 9.13). Rays that
/// a surface scatters find a small lamp seldom: with the balance heuristic each of them would
/// weigh so much that they make most of the noise of direct light.
inline double power_weight(double own, double other) {
    return own > 0.0 ? square(own) / (square(own) + square(other)) : 0.0;
}

/// How sampled points of the lights count.
enum class LightSamples {
    weighed,  ///< against directions that the BSDF samples; unbiased together with
              ///< emission_weight()
    alone     ///< unbiased by themselves
};

/// Which of the sampled points of the lights are tested for what stands in their way; unbiased
/// either way.
enum class ShadowRays {
    of_all,  ///< but for those that matter little, by roulette
    of_one   ///< chosen by the luminance that it would bring: where many paths share the work
};

/// True where sampled points of the lights have little noise by themselves, so that no scattered
/// ray need look for emission: at a diffuse surface, if each light either is sampled by solid angle
/// or looks small from x.
bool lights_suffice(const Stage& stage, const Bsdf& bsdf, const Vec3& x);

/// Radiance scattered toward wo from sampled points of the lights.
/// @param surface  where the shadow rays leave; nullptr for a point in free space.
/// @param split  where rays follow both kinds of events, of each its own; else of one kind.
/// @param media_above, media_below  solids that hold the space on both sides of the surface.
Lanes direct_light(const Phase& phase, const GatherPoint& at, const SurfacePoint* surface,
                   const MediumStack& media_above, const MediumStack& media_below,
                   LightSamples samples, const EventSplit& split, ShadowRays shadow_rays,
                   StratifiedStream& random, std::uint64_t& shadow_segments);

/// Weight of emission found by a direction that the BSDF chose with density `pdf_solid_angle` from
/// x.
double emission_weight(const Phase& phase, std::uint32_t light, const Vec3& x,
                       const SurfacePoint& emitter, double pdf_solid_angle);

/// Emitted spectral radiance of a surface point toward a direction [W/(m2 sr nm)].
Lanes emitted_radiance(const Phase& phase, std::uint32_t light, const SurfacePoint& point,
                       const Vec3& direction);

}  // namespace lucerna::optics
