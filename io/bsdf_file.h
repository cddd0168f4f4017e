// Measured scattering data from any file that Lucerna reads.
#pragma once

#include <filesystem>
#include <memory>

#include "optics/material/measured_bsdf.h"

namespace lucerna::io {

/// Largest sum of reflectance and transmittance in any direction that a file may have: matrices are
/// written with few digits and by noisy measurements and simulations. Beyond 1 there is a warning.
inline constexpr double max_directional_hemispherical = 1.01;

/// Reads LBNL XML (see bsdf_xml.h) or Lucerna's table (see bsdf_table.h), told apart by the first
/// character of the file. Throws InputError.
std::shared_ptr<const optics::MeasuredBsdf> read_bsdf_file(const std::filesystem::path& path);

}  // namespace lucerna::io
