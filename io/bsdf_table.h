// Lucerna's plain text table of an isotropic measured BSDF; the format is in docs/bsdf_table.md.
#pragma once

#include "io/bsdf_file.h"
#include "io/photometric_reading.h"

namespace lucerna::io {

/// Reads a table. Every part (reflection or transmission, light on the front or the back) is either
/// a full grid of angles and wavelengths or declared black. Throws InputError.
optics::MeasuredBsdf read_bsdf_table(const TextFile& file);

}  // namespace lucerna::io
