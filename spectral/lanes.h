// The values of a spectral quantity at the wavelengths of one phase.
#pragma once

#include <Eigen/Core>

namespace lucerna::spectral {

/// Wavelengths per phase. Sixteen floats are one 512-bit or two 256-bit registers.
inline constexpr int lane_count = 16;

/// One value per wavelength of the phase. Spectral quantities are per nanometre.
using Lanes = Eigen::Array<float, lane_count, 1>;

}  // namespace lucerna::spectral
