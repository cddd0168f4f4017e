// From the planes that an LM-63 file stores to C planes all around.
#pragma once

#include <string>
#include <vector>

#include "io/photometric_reading.h"

namespace lucerna {

/// C planes from 0 to 360 deg, or a single one of a luminaire that is the same all around.
struct FullCircle {
    PlaneTable table;
    std::string symmetry;                 ///< by which the file leaves out planes
    std::vector<std::string> deviations;  ///< from the standard, and how they are read
    std::vector<std::string> notes;
};

/// @param type    photometric type: 'A', 'B' or 'C'.
/// @param stored  horizontal angles as c_deg, vertical angles as gamma_deg [deg], intensities.
/// @param place   of the first horizontal angle, for messages.
/// Throws InputError if the horizontal angles are none that LM-63 knows.
FullCircle full_circle(char type, const PlaneTable& stored, const SourceLocation& place);

}  // namespace lucerna
