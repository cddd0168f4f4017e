// Measured scattering data: matrices on Klems bases, and plain tables of angles and wavelengths.
//
// A measured BSDF need not be reciprocal. Its f is always that of light that arrives from one
// direction and leaves toward another, whichever way the path is traced: with Transport::radiance
// light arrives from wi and leaves toward wo, with Transport::flux it arrives from wo and leaves
// toward wi.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "optics/material/klems_bsdf.h"
#include "optics/material/tabulated_bsdf.h"

namespace lucerna::optics {

/// Closed list of the forms in which measured data come.
struct MeasuredBsdf {
    std::variant<KlemsBsdf, TabulatedBsdf> data;
    /// What its reader had to assume, such as a part that was not measured; for the report.
    std::vector<std::string> warnings{};
};

/// True if f does not change when the surface is turned around its normal, so that no direction on
/// the surface needs to be known.
bool is_isotropic(const MeasuredBsdf& measured);

/// From how few directions comes what is scattered toward wo: pi times the integral of f^2 |cos|
/// over the square of that of f |cos|, over the side of wo (`reflection`) or the other; 1 where f
/// is constant, 0 where it is 0. A mean over photons that arrive from all around has the noise of
/// as many times fewer photons than at a Lambertian surface.
double concentration(const MeasuredBsdf& measured, const Vec3& wo, bool reflection,
                     const spectral::WavelengthSet& wavelengths);

/// True if the data let light pass in at least one direction.
bool transmits(const MeasuredBsdf& measured);

}  // namespace lucerna::optics
