// The inside of transparent solids.
#pragma once

#include <string>

#include "optics/material/bsdf.h"

namespace lucerna::optics {

using MediumId = std::uint32_t;

/// Homogeneous, not scattering. Where solids overlap, the one with the higher priority counts.
struct Medium {
    std::string name;
    SpectrumId index;             ///< index of refraction n(lambda)
    SpectrumId absorption_per_m;  ///< Beer-Lambert coefficient alpha(lambda) [1/m]
    bool dispersive = false;      ///< n depends on wavelength
    bool absorbing = false;       ///< alpha is not 0 everywhere
    int priority = 0;
};

}  // namespace lucerna::optics
