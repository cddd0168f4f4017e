// BSDF matrices in the XML of LBNL WINDOW 6/7 and of Radiance's genBSDF (schema BSDF-v1.4).
#pragma once

#include "io/bsdf_file.h"
#include "io/photometric_reading.h"

namespace lucerna::io {

/// Reads the matrices of the wavelength "Visible" (or "CIE-Y"), taken as the same at all
/// wavelengths; blocks of other wavelengths ("Solar", "NIR", "CIE-X" ...) are not used.
///
/// Bases are those of the file (AngleBasis), else the three LBNL/Klems bases. Of the parts
/// "Transmission Front/Back" and "Reflection Front/Back" (where the light arrives, the front being
/// the outer side, our +z) a missing transmission follows from the other by reciprocity, any other
/// missing part is black; both with a warning. Throws InputError, for tensor trees as well.
optics::MeasuredBsdf read_bsdf_xml(const TextFile& file);

}  // namespace lucerna::io
