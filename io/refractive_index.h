// Refractive indices from files of the refractiveindex.info database (YAML).
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "spectral/spectrum.h"

namespace lucerna::io {

/// What such a file says about the range in which Lucerna simulates.
struct RefractiveIndexData {
    spectral::Spectrum n;                 ///< index of refraction, held outside its range
    std::optional<spectral::Spectrum> k;  ///< extinction coefficient, if the file has it
    double min_nm = 0.0;                  ///< range of wavelengths in which the file gives n
    double max_nm = 0.0;
    std::string reference;              ///< source of the data as named by the file, as plain text
    bool dispersive = false;            ///< n varies between 360 nm and 830 nm
    std::vector<std::string> warnings;  ///< such as values held outside their range
};

/// Reads the entries "formula 1" to "formula 9", "tabulated nk", "tabulated n" and "tabulated k"
/// of a file, of which n must be given once and k at most once. Wavelengths of the file are in
/// micrometres. A formula becomes a table that follows it to 3e-7.
///
/// Throws InputError with all that is wrong with the file, also if it says nothing about n between
/// 360 nm and 830 nm.
RefractiveIndexData read_refractive_index(const std::filesystem::path& path);

}  // namespace lucerna::io
