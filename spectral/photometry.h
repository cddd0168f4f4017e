// From radiant to luminous quantities.
#pragma once

#include "spectral/spectrum.h"

namespace lucerna::spectral {

/// Luminous quantity of a spectral radiant one, photopic.
///
///   Phi_v = K_m * integral of Phi_e,lambda(lambda) V(lambda) d lambda          ILV 17-21-039, note
///   1
///
/// @param spectral  spectral radiant flux [W/nm], radiance [W/(m2 sr nm)], irradiance ...
/// @return  luminous flux [lm], luminance [cd/m2], illuminance [lx] ...
/// Exact for piecewise linear data up to rounding.
double luminous(const Spectrum& spectral);

/// Luminous efficacy of radiation [lm/W]: luminous flux over radiant flux, both on 360-830 nm.
/// Throws std::invalid_argument if there is no radiant flux.
double luminous_efficacy_of_radiation(const Spectrum& spectral);

/// The spectral radiant flux [W/nm] with the shape of `relative` and the given luminous flux [lm]
/// (or the like for any other luminous quantity).
/// Throws std::invalid_argument if `relative` has no luminous content or the flux is negative.
Spectrum scaled_to_luminous(const Spectrum& relative, double luminous_flux_lm);

}  // namespace lucerna::spectral
