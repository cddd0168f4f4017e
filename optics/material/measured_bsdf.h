// Measured scattering data: matrices on Klems bases, and plain tables of angles and wavelengths.
//
// A measured BSDF need not be reciprocal. Its f is always that of light that arrives from one
// direction and leaves toward another, whichever way the path is traced: with Transport::radiance
// light arrives from wi and leaves toward wo, with Transport::flux it arrives from wo and leaves
// toward wi.
#pragma once

#include <variant>

#include "optics/material/klems_bsdf.h"
#include "optics/material/tabulated_bsdf.h"

namespace lucerna::optics {

/// Closed list of the forms in which measured data come.
struct MeasuredBsdf {
    std::variant<KlemsBsdf, TabulatedBsdf> data;
};

/// True if the data let light pass in at least one direction.
bool transmits(const MeasuredBsdf& measured);

}  // namespace lucerna::optics
