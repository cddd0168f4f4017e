// Fresnel's equations and Snell's law at a plane boundary, and mirror directions.
#pragma once

#include "optics/material/polarisation.h"

namespace lucerna::optics {

/// Reflectance of flux for light polarised perpendicular (s) and parallel (p) to the plane of
/// incidence.
struct FresnelReflectance {
    double s, p;
    double unpolarised() const { return 0.5 * (s + p); }
};

/// Boundary between transparent media; 1 for both polarisations under total internal reflection.
///
/// @param cos_incidence  in [0, 1], of the angle on the side where the light comes from.
/// @param eta            index beyond the boundary over the index before it, > 0.
FresnelReflectance fresnel_dielectric(double cos_incidence, double eta);

/// Boundary of a transparent medium to a metal, exact for the complex index (n + ik).
///
/// @param n, k  real and imaginary part of the metal's index over the index before the boundary.
FresnelReflectance fresnel_conductor(double cos_incidence, double n, double k);

/// Unpolarised reflectance on each lane.
Lanes fresnel_dielectric(double cos_incidence, const Lanes& eta);
Lanes fresnel_conductor(double cos_incidence, const Lanes& n, const Lanes& k);

/// The same reflections as Mueller matrices, with the phases of total reflection and of metals.
Mueller<double> dielectric_reflection(double cos_incidence, double eta);
Mueller<Lanes> dielectric_reflection(double cos_incidence, const Lanes& eta);
Mueller<double> conductor_reflection(double cos_incidence, double n, double k);
Mueller<Lanes> conductor_reflection(double cos_incidence, const Lanes& n, const Lanes& k);

/// Refraction of what a boundary between transparent media does not reflect, as a factor of flux.
Mueller<double> refraction(const Mueller<double>& reflection);

/// Direction refracted by Snell's law, pointing away from the surface.
///
/// @param wo      unit, pointing away from the surface, wo.m >= 0.
/// @param m       unit normal of the (micro)surface on the side of wo.
/// @param eta     index beyond over index before; at 1 the result is exactly -wo.
/// The caller excludes total internal reflection; at the critical angle and rounded beyond it the
/// result grazes the surface.
Vec3 refract(const Vec3& wo, const Vec3& m, double eta);

/// Mirror direction of wo about m, both pointing away from the surface.
inline Vec3 reflect(const Vec3& wo, const Vec3& m) {
    return 2.0 * wo.dot(m) * m - wo;
}

}  // namespace lucerna::optics
