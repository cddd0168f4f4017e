// The tables of data/colorimetry, compiled into the library.
#pragma once

#include <string_view>
#include <vector>

#include "spectral/spectrum.h"

namespace lucerna::spectral {

/// A file of data/colorimetry: its name without extension and its text.
struct CieTable {
    std::string_view name;
    std::string_view csv;
};

/// All tables; generated at build time.
const std::vector<CieTable>& cie_tables();

/// Names of the value columns of a table, in the order of the file.
std::vector<std::string_view> cie_columns(std::string_view table);

/// A column of a table over the wavelengths at which it has a value.
/// Throws std::out_of_range if there is no such table or column.
Spectrum cie_column(std::string_view table, std::string_view column, Outside outside);

}  // namespace lucerna::spectral
