// Numbers with their uncertainty as people read them.
#pragma once

#include <string>

namespace lucerna::io {

/// "512.3 ± 1.4": the expanded uncertainty U to two significant digits and the value to the same
/// place (JCGM 100:2008, 7.2.6); "1.25e+06 ± 3.1e+04" beyond a million; without " ± ..." where U is
/// 0; "512.3 ± unknown" where U is not finite.
std::string measured_value(double value, double expanded_uncertainty);

/// "1.2 GB", "35 MB": three significant digits at most, in powers of 1000.
std::string byte_size(double bytes);

}  // namespace lucerna::io
