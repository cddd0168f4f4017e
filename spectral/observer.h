// The CIE 1931 standard colorimetric observer (2 deg) and the photopic observer.
#pragma once

#include "spectral/spectrum.h"

namespace lucerna::spectral {

/// Maximum luminous efficacy of radiation for photopic vision [lm/W]: 683 lm/W are fixed at the
/// frequency 540e12 Hz (555.02 nm in air), where V(lambda) = 0.999997 (CIE 018:2019).
inline constexpr double max_luminous_efficacy_lm_per_w = 683.002;

/// Colour-matching functions at 1 nm, 360-830 nm, zero outside (ISO/CIE 11664-1:2019).
const Spectrum& x_bar();
const Spectrum& z_bar();

/// V(lambda), which is also y-bar by definition of the 1931 observer, so that Y is the luminance.
const Spectrum& v_lambda();

}  // namespace lucerna::spectral
