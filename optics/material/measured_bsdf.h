// Measured scattering data: matrices on Klems bases, and plain tables of angles and wavelengths.
#pragma once

#include <string>
#include <vector>

#include "core/vector.h"
#include "spectral/lanes.h"
#include "spectral/spectrum.h"
#include "spectral/wavelength_set.h"

namespace lucerna::optics {

struct MeasuredBsdf;  // to be replaced by the real definition

}  // namespace lucerna::optics
