#include "spectral/cie_tables.h"

#include <algorithm>
#include <charconv>
#include <stdexcept>

namespace lucerna::spectral {
namespace {

std::vector<std::string_view> split(std::string_view text, char separator) {
    std::vector<std::string_view> parts;
    for (std::size_t end; (end = text.find(separator)) != text.npos; text.remove_prefix(end + 1)) {
        parts.push_back(text.substr(0, end));
    }
    parts.push_back(text);
    return parts;
}

// The lines of a table that hold text: the header and the rows.
std::vector<std::string_view> lines_of(std::string_view table) {
    for (const CieTable& candidate : cie_tables()) {
        if (candidate.name != table) continue;
        std::vector<std::string_view> lines = split(candidate.csv, '\n');
        std::erase_if(lines, [](std::string_view line) { return line.empty(); });
        return lines;
    }
    throw std::out_of_range("no CIE table of this name");
}

double number(std::string_view cell) {
    double value = 0.0;
    const auto [end, error] = std::from_chars(cell.begin(), cell.end(), value);
    if (error != std::errc{} || end != cell.end()) throw std::logic_error("broken CIE table");
    return value;
}

}  // namespace

std::vector<std::string_view> cie_columns(std::string_view table) {
    std::vector<std::string_view> header = split(lines_of(table).front(), ',');
    header.erase(header.begin());
    return header;
}

Spectrum cie_column(std::string_view table, std::string_view column, Outside outside) {
    const std::vector<std::string_view> lines = lines_of(table);
    const std::vector<std::string_view> header = split(lines.front(), ',');
    const auto found = std::find(header.begin() + 1, header.end(), column);
    if (found == header.end()) throw std::out_of_range("no such column in the CIE table");
    const auto index = static_cast<std::size_t>(found - header.begin());

    std::vector<double> wavelengths_nm;
    std::vector<double> values;
    for (std::size_t row = 1; row < lines.size(); ++row) {
        const std::vector<std::string_view> cells = split(lines[row], ',');
        if (cells.at(index).empty()) continue;  // tables of a file differ in range
        wavelengths_nm.push_back(number(cells.front()));
        values.push_back(number(cells[index]));
    }
    return {std::move(wavelengths_nm), std::move(values), outside};
}

}  // namespace lucerna::spectral
