// Colour of a stimulus: CIE 1931 tristimulus values and what is derived from them.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "spectral/spectrum.h"

namespace lucerna::spectral {

/// CIE 1931 tristimulus values on the photometric scale: y is the luminance [cd/m2] of a radiance,
/// the illuminance [lx] of an irradiance, and so on.
struct Xyz {
    double x = 0.0;
    double y = 0.0;
    double z = 0.0;
};

/// Chromaticity coordinates (x, y) of CIE 1931.
struct Chromaticity {
    double x = 0.0;
    double y = 0.0;
};

/// Coordinates of a uniform chromaticity diagram: (u', v') of 1976 or (u, v) of 1960.
struct UniformChromaticity {
    double u = 0.0;
    double v = 0.0;
};

/// Correlated colour temperature and the distance from the Planckian locus in (u, v) of 1960,
/// positive on the green side.
struct ColourTemperature {
    double cct_k = 0.0;
    double duv = 0.0;
};

/// X, Y, Z = K_m * integral of g times x-bar, V, z-bar; exact for piecewise linear data.
Xyz tristimulus(const Spectrum& spectral);

/// x = X / (X + Y + Z), y = Y / (X + Y + Z); nothing for black.
std::optional<Chromaticity> chromaticity(const Xyz& colour);

/// u' = 4X / (X + 15Y + 3Z), v' = 9Y / (X + 15Y + 3Z) (ISO/CIE 11664-5); nothing for black.
std::optional<UniformChromaticity> chromaticity_1976(const Xyz& colour);

/// u = u', v = 2/3 v', the diagram in which colour temperature is defined; nothing for black.
std::optional<UniformChromaticity> chromaticity_1960(const Xyz& colour);

/// Correlated colour temperature (as defined in CIE 15:2018): the temperature of the black body
/// that is nearest in (u, v) of 1960. Found as the minimum of the distance to black bodies computed
/// from Planck's law with c2 of CODATA 2018 and sums at 1 nm; a black body's own temperature comes
/// back to within 1e-4 of it. Nothing for black, for |Duv| > 0.05, where the notion loses its
/// meaning, and where the nearest black body is not between 1000 K and 100 000 K.
std::optional<ColourTemperature> correlated_colour_temperature(const Xyz& colour);

/// Linear sRGB from tristimulus values (IEC 61966-2-1): primaries of ITU-R BT.709, white
/// x = 0.3127, y = 0.3290, for which Y = 1 gives (1, 1, 1). Colours outside the gamut come out
/// negative or above 1.
const Eigen::Matrix3d& linear_srgb_from_xyz();

}  // namespace lucerna::spectral
