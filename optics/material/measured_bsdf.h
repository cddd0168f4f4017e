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

/// True if the data let light pass in at least one direction.
bool transmits(const MeasuredBsdf& measured);

}  // namespace lucerna::optics
