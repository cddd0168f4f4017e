// Spectra from tables of text.
#pragma once

#include <filesystem>
#include <string_view>

#include "spectral/spectrum.h"

namespace lucerna::io {

/// Reads one column of a table of comma, semicolon or tab separated values.
///
///     # comment
///     wavelength_nm,wall,floor
///     380,0.41,0.12
///
/// The header names the unit of the first column: wavelength_nm, nm, "wavelength [nm]", or the same
/// with um or µm. Wavelengths increase; values are numbers of zero or more with a decimal point. A
/// column may begin later and end earlier than the table: its cells are empty there.
///
/// @param column   name in the header, compared as written; may be empty if there is just one.
/// @param outside  what the spectrum is outside of its table.
/// Throws InputError with all that is wrong with the file, each with its line and column.
spectral::Spectrum read_spectrum_csv(const std::filesystem::path& path, std::string_view column,
                                     spectral::Outside outside);

}  // namespace lucerna::io
