// EULUMDAT: Stockmar, "EULUMDAT - ein Leuchtendatenformat fuer den europaeischen
// Beleuchtungsplaner", Licht '90, and its description at helios32.com/Eulumdat.htm.
#pragma once

#include "io/photometric_file.h"
#include "io/photometric_reading.h"

namespace lucerna {

/// Reads an EULUMDAT file: intensities in cd/klm are scaled by the flux of the lamp set and by the
/// conversion factor. A negative number of lamps says absolute photometry: the flux is that of the
/// luminaire (agreement of DIAL and Lighting Analysts, 2009).
/// @param lamp_set  from 1.
PhotometricFile read_eulumdat(const TextFile& file, int lamp_set);

}  // namespace lucerna
