// IES LM-63: 1986, 1991, 1995, 2002 and 2019.
#pragma once

#include "io/photometric_file.h"
#include "io/photometric_reading.h"

namespace lucerna {

/// Reads an LM-63 file of any edition (ANSI/IES LM-63-19 and predecessors).
///
/// Intensities are multiplied by the candela multiplier, the ballast factor, the ballast-lamp
/// photometric factor (before 2019; since 2019 this field tells how the file was made) and by the
/// tilt factor for the luminaire in its photometric position (0 deg); that of other positions is
/// not modelled. Photometric types A and B are resampled onto C planes.
PhotometricFile read_ies(const TextFile& file);

/// True if the text has the TILT= line that every LM-63 file has.
bool looks_like_ies(const TextFile& file);

}  // namespace lucerna
