// Images as OpenEXR files, always in 32-bit floats.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "io/luminance_image.h"
#include "optics/transport/result.h"

namespace lucerna::io {

/// What an image file says about the run that made it.
struct Provenance {
    std::uint32_t phases = 0;
    std::vector<std::uint64_t> seeds;  ///< of the runs that were joined
    std::string scene_hash;
};

/// Luminance with its error, and colour:
///
///   luminance.Y, luminance.standard_error, luminance.bias,
///   luminance.correction    [cd/m2], as in the report; the last is added to the mean for the bias
///   R, G, B    linear, primaries of BT.709, scaled such that R = G = B = L is white of L cd/m2
///
/// with the attributes chromaticities, whiteLuminance = 1, units, phases, seed, sceneHash, delta,
/// software. The standard error of an image of one phase is infinite, and is written so.
void write_exr(const std::filesystem::path& path, const optics::Image& image,
               const Provenance& provenance);

/// Spectral layout of Fichet, Pacanowski and Wilkie, "An OpenEXR Layout for Spectral Images", JCGT
/// 10(3), 2021.
///
///   S0.<centre of the bin, decimal comma>nm    radiance in the bin = mean spectral radiance * bin
///   width R, G, B                                    as above, for viewers that know no spectra
///
/// Attributes of the layout: spectralLayoutVersion "1.0", emissiveUnits "W.m^-2.sr^-1". Of our own,
/// because the layout leaves the bins open: spectralQuantity "radiance per bin" and binEdges_nm.
/// Throws std::invalid_argument if the image holds no spectra.
void write_spectral_exr(const std::filesystem::path& path, const optics::Image& image,
                        const Provenance& provenance);

/// Reads luminance.Y with its errors where present, else Y, else R, G, B weighted to
/// luminance by BT.709 and whiteLuminance. Throws InputError.
LuminanceImage read_exr(const std::filesystem::path& path);

}  // namespace lucerna::io
