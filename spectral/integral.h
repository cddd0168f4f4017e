// Integrals over wavelength.
#pragma once

#include "spectral/spectrum.h"

namespace lucerna::spectral {

/// Integral of a(lambda) b(lambda) d lambda from one wavelength to another [nm times both units].
/// Exact for piecewise linear data, because it works on the union of both grids.
double integral_of_product(const Spectrum& a, const Spectrum& b, double from_nm = min_wavelength_nm,
                           double to_nm = max_wavelength_nm);

}  // namespace lucerna::spectral
