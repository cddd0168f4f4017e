#include "io/spectrum_csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core/diagnostics.h"

namespace lucerna::io {
namespace {

using spectral::Outside;
using spectral::Spectrum;

struct Cell {
    std::string text;
    int column;  // from 1, in bytes
};

struct Line {
    int number;  // from 1
    std::string text;
};

std::string read_text(const std::filesystem::path& path) {
    constexpr std::uintmax_t max_bytes = 64u << 20;
    std::error_code failure;
    if (!std::filesystem::is_regular_file(path, failure)) {
        throw InputError({path.string()}, "no such file");
    }
    const std::uintmax_t bytes = std::filesystem::file_size(path, failure);
    if (failure) throw InputError({path.string()}, "cannot be read: " + failure.message());
    if (bytes > max_bytes) {
        throw InputError({path.string()},
                         fmt::format("has {} bytes; at most {} are read", bytes, max_bytes));
    }
    std::ifstream stream(path, std::ios::binary);
    std::string text((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
    if (!stream) throw InputError({path.string()}, "cannot be read");
    return text;
}

// The lines that are neither empty nor comments.
std::vector<Line> content_lines(const std::string& text) {
    constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
    std::vector<Line> lines;
    std::size_t start = text.starts_with(byte_order_mark) ? byte_order_mark.size() : 0;
    for (int number = 1; start < text.size(); ++number) {
        const std::size_t end = std::min(text.find('\n', start), text.size());
        std::string line = text.substr(start, end - start);
        start = end + 1;
        if (line.ends_with('\r')) line.pop_back();
        const std::size_t first = line.find_first_not_of(" \t");
        if (first != line.npos && line[first] != '#') lines.push_back({number, std::move(line)});
    }
    return lines;
}

// Cells without the blanks and quotation marks around them.
std::vector<Cell> split(const std::string& line, char separator) {
    std::vector<Cell> cells;
    for (std::size_t start = 0;;) {
        const std::size_t end = std::min(line.find(separator, start), line.size());
        std::size_t from = start;
        std::size_t to = end;
        while (from < to && (line[from] == ' ' || line[from] == '\t')) ++from;
        while (to > from && (line[to - 1] == ' ' || line[to - 1] == '\t')) --to;
        if (to - from >= 2 && line[from] == '"' && line[to - 1] == '"') ++from, --to;
        cells.push_back({line.substr(from, to - from), static_cast<int>(from) + 1});
        if (end == line.size()) return cells;
        start = end + 1;
    }
}

char separator_of(const std::string& header) {
    for (const char candidate : {'\t', ';'}) {
        if (header.find(candidate) != header.npos) return candidate;
    }
    return ',';
}

// Nanometres per unit of a header such as "wavelength_nm", "nm", "Wavelength [nm]" or "lambda
// (um)".
std::optional<double> wavelength_unit_nm(std::string heading) {
    std::transform(heading.begin(), heading.end(), heading.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
    while (heading.ends_with(']') || heading.ends_with(')')) heading.pop_back();
    const std::size_t separator = heading.find_last_of("_ [(/");
    const std::string unit = separator == heading.npos ? heading : heading.substr(separator + 1);
    if (unit == "nm") return 1.0;
    // the micro sign and the Greek letter mu
    if (unit == "um" || unit == "\u00B5m" || unit == "\u03BCm") return 1e3;
    return std::nullopt;
}

class Reader {
public:
    Reader(const std::filesystem::path& path, Outside outside)
        : file_(path.string()), outside_(outside), lines_(content_lines(read_text(path))) {}

    Spectrum read(std::string_view column) {
        if (lines_.empty()) throw InputError({file_}, "is empty; expected a header and rows");
        const Line& header_line = lines_.front();
        separator_ = separator_of(header_line.text);
        const std::vector<Cell> header = split(header_line.text, separator_);
        const std::optional<double> unit_nm = wavelength_unit_nm(header.front().text);
        if (!unit_nm) {
            complain(header_line, header.front(),
                     fmt::format("'{}' names no unit of wavelength; expected a first column such "
                                 "as wavelength_nm or wavelength_um",
                                 header.front().text));
        }
        const std::optional<std::size_t> index = column_index(header, column);
        for (auto line = lines_.begin() + 1; line != lines_.end(); ++line) {
            read_row(*line, header.size(), unit_nm.value_or(1.0), index);
        }
        if (index && diagnostics_.empty() && values_.size() < 2) {
            complain(header_line, header[*index],
                     fmt::format("'{}' has {} values; expected at least 2", header[*index].text,
                                 values_.size()));
        }
        diagnostics_.throw_if_any();
        return {std::move(wavelengths_nm_), std::move(values_), outside_};
    }

private:
    void complain(const Line& line, const Cell& cell, std::string message) {
        diagnostics_.add({file_, line.number, cell.column}, std::move(message));
    }

    std::optional<std::size_t> column_index(const std::vector<Cell>& header,
                                            std::string_view column) {
        std::vector<std::string> names;
        for (std::size_t i = 1; i < header.size(); ++i) names.push_back(header[i].text);
        const std::string list = fmt::format("{}", fmt::join(names, ", "));
        if (names.empty()) {
            complain(lines_.front(), header.front(),
                     "there is no column of values; expected cells separated by a comma, "
                     "semicolon or tab");
            return std::nullopt;
        }
        if (column.empty()) {
            if (names.size() == 1) return 1;
            complain(lines_.front(), header[1],
                     fmt::format("no column was chosen; expected one of: {}", list));
            return std::nullopt;
        }
        const auto found = std::find(names.begin(), names.end(), column);
        if (found == names.end()) {
            const std::string nearest = nearest_word(std::string(column), names);
            complain(lines_.front(), header[1],
                     fmt::format("there is no column '{}'; expected one of: {}{}", column, list,
                                 nearest.empty() ? "" : "; did you mean '" + nearest + "'?"));
            return std::nullopt;
        }
        if (std::find(found + 1, names.end(), column) != names.end()) {
            complain(lines_.front(), header[1], fmt::format("there are two columns '{}'", column));
        }
        return static_cast<std::size_t>(found - names.begin()) + 1;
    }

    void read_row(const Line& line, std::size_t cell_count, double unit_nm,
                  std::optional<std::size_t> index) {
        const std::vector<Cell> cells = split(line.text, separator_);
        if (cells.size() != cell_count) {
            complain(
                line, cells.front(),
                fmt::format("{} cells; expected {} as in the header", cells.size(), cell_count));
            return;
        }
        const double wavelength_nm = unit_nm * number(line, cells.front());
        if (wavelength_nm <= 0.0) complain(line, cells.front(), "a wavelength must be positive");
        if (wavelength_nm <= last_wavelength_nm_) {
            complain(line, cells.front(), "wavelengths must increase from row to row");
        }
        if (!std::isnan(wavelength_nm)) last_wavelength_nm_ = wavelength_nm;
        if (index) read_value(line, cells[*index], wavelength_nm);
    }

    void read_value(const Line& line, const Cell& cell, double wavelength_nm) {
        if (cell.text.empty()) {
            column_ended_ = !values_.empty();
            return;
        }
        if (column_ended_) {
            complain(line, cell, "a value behind an empty cell; a column must have no gaps");
            column_ended_ = false;
        }
        const double value = number(line, cell);
        if (value < 0.0) {
            complain(line, cell, fmt::format("{} is negative; expected zero or more", cell.text));
        }
        wavelengths_nm_.push_back(wavelength_nm);
        values_.push_back(value);
    }

    // NaN after a complaint.
    double number(const Line& line, const Cell& cell) {
        double value = 0.0;
        const char* begin = cell.text.data() + (cell.text.starts_with('+') ? 1 : 0);
        const char* end = cell.text.data() + cell.text.size();
        const auto [stop, error] = std::from_chars(begin, end, value);
        if (error == std::errc{} && stop == end && std::isfinite(value)) return value;
        complain(line, cell,
                 fmt::format("'{}' is not a finite number; expected one with a decimal point, "
                             "such as 0.5",
                             cell.text));
        return std::numeric_limits<double>::quiet_NaN();
    }

    std::string file_;
    Outside outside_;
    std::vector<Line> lines_;
    char separator_ = ',';
    Diagnostics diagnostics_;
    double last_wavelength_nm_ = -std::numeric_limits<double>::infinity();
    bool column_ended_ = false;
    std::vector<double> wavelengths_nm_;
    std::vector<double> values_;
};

}  // namespace

Spectrum read_spectrum_csv(const std::filesystem::path& path, std::string_view column,
                           Outside outside) {
    return Reader(path, outside).read(column);
}

}  // namespace lucerna::io
