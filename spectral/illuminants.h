// Spectra of illuminants by name, of daylight and of black bodies.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "spectral/spectrum.h"

namespace lucerna::spectral {

/// Relative spectral distribution of an illuminant of CIE 15:2018; zero outside its table.
///
/// Known are A, C, D50, D55, D65, D75, E, FL1 ... FL12, FL3.1 ... FL3.15, HP1 ... HP5, LED-B1 ...
/// LED-B5, LED-BH1, LED-RGB1, LED-V1, LED-V2, ID50 and ID65, in capitals or small letters, with or
/// without "CIE-" in front; F1 is FL1 and so on. Nothing if unknown.
///
/// Most tables end at 780 nm and have a step of 5 nm. The sums at 5 nm by which the CIE prints the
/// chromaticity of FL, HP and LED differ from the integral of the interpolated table by up to
/// 3e-4 in x or y (tests/spectral/test_illuminants.cpp).
std::optional<Spectrum> illuminant(std::string_view name);

/// The names that illuminant() knows, without their variants.
std::vector<std::string> illuminant_names();

/// The range in which daylight() is defined.
inline constexpr double min_daylight_cct_k = 4000.0;
inline constexpr double max_daylight_cct_k = 25000.0;

/// Relative spectral distribution of a phase of daylight, 100 at 560 nm (CIE 15:2018, illuminants
/// D).
///
/// @param cct_k  correlated colour temperature on today's scale. D65 is daylight(6503.6): its
///               6500 K were meant with c2 = 1.4380e-2 m K, and today's c2 is 1.4388e-2 m K.
/// Differs: M1 and M2 are not rounded to three decimals, as in the tables of D50 ... D75.
/// Throws std::invalid_argument outside of the range above.
Spectrum daylight(double cct_k);

/// Spectral radiance of a black body [W/(m2 sr nm)] by Planck's law in vacuum, tabulated at 1 nm
/// on 360-830 nm and zero outside.
///
///   L = c_1L lambda^-5 / (exp(c2 / (lambda T)) - 1),  c_1L = 2 h c^2,  c2 = h c / k  (CODATA 2018)
///
/// Throws std::invalid_argument unless the temperature is positive and finite.
Spectrum planck(double temperature_k);

}  // namespace lucerna::spectral
