// Spectra in a scene file: numbers, files, lists of points, and illuminants by name.
#pragma once

#include "io/scene_context.h"
#include "spectral/spectrum.h"

namespace lucerna::io {

/// What a spectrum is the spectrum of; says its unit, its range and what it is outside its table.
enum class SpectrumOf {
    fraction,    ///< reflectance or transmittance, 0 to 1; held outside its table
    absorption,  ///< absorption coefficient, 1/m; held
    index,       ///< index of refraction or extinction coefficient, >= 0; held
    emission     ///< relative spectral distribution, >= 0 and visible; zero outside its table
};

/// Reads a number (flat), {file, column} or {points: [[400 nm, 0.1], ...]}; an emission may also be
/// the name of an illuminant, {planck: 2856 K} or {daylight: 6500 K}. Nothing after a complaint.
std::optional<spectral::Spectrum> read_spectrum(SceneContext& context, const YamlCursor& cursor,
                                                SpectrumOf quantity);

/// Largest value of a + b over the simulated range: both are linear between their nodes.
double max_of_sum(const spectral::Spectrum& a, const spectral::Spectrum& b);

/// A warning if a spectrum that is held outside its table does not cover the visible range.
void warn_if_held(SceneContext& context, const YamlCursor& at, const spectral::Spectrum& spectrum);

}  // namespace lucerna::io
