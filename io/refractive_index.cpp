#include "io/refractive_index.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "core/diagnostics.h"
#include "io/yaml_cursor.h"
#include "spectral/dispersion_formula.h"

namespace lucerna::io {
namespace {

using spectral::max_wavelength_nm;
using spectral::min_wavelength_nm;
using spectral::Outside;
using spectral::Spectrum;

constexpr YamlLimits limits = {.bytes = 16u << 20};

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::size_t start = 0;
    for (std::size_t end; (end = text.find('\n', start)) != text.npos; start = end + 1) {
        lines.push_back(text.substr(start, end - start));
    }
    lines.push_back(text.substr(start));
    return lines;
}

// "a <i>b</i>\n  c" -> "a b c"
std::string plain_text(const std::string& html) {
    std::string text;
    bool in_tag = false;
    for (const char c : html) {
        if (c == '<') in_tag = true;
        if (!in_tag) {
            const bool blank = c == ' ' || c == '\n' || c == '\r' || c == '\t';
            if (!blank) text += c;
            if (blank && !text.empty() && text.back() != ' ') text += ' ';
        }
        if (c == '>') in_tag = false;
    }
    if (!text.empty() && text.back() == ' ') text.pop_back();
    return text;
}

bool overlaps_simulated_range(double from_nm, double to_nm) {
    return from_nm <= max_wavelength_nm && to_nm >= min_wavelength_nm;
}

// What the file gives for n or for k.
struct Curve {
    Spectrum values;
    double min_nm;
    double max_nm;
};

class Reader {
public:
    explicit Reader(const std::filesystem::path& path) : path_(path), file_(path.string()) {}

    RefractiveIndexData read() {
        const auto root = read_yaml_file(path_, diagnostics_, limits);
        std::ifstream stream(path_, std::ios::binary);
        lines_ = lines_of({std::istreambuf_iterator<char>(stream), {}});
        YamlMap map(YamlCursor(*root, file_, diagnostics_));
        RefractiveIndexData result;
        const YamlCursor data = map.required("DATA", "a list of formulas and tables");
        const YamlCursor references = map.optional("REFERENCES");
        if (references.is_scalar()) result.reference = plain_text(references.word().value_or(""));
        for (const YamlCursor& entry : data.list()) read_entry(entry, result);
        if (data && !found_index_) {
            data.complain(
                "holds no index of refraction; expected an entry 'formula 1' to "
                "'formula 9', 'tabulated nk' or 'tabulated n'");
        }
        diagnostics_.throw_if_any();

        result.n = n_->values;
        result.min_nm = n_->min_nm;
        result.max_nm = n_->max_nm;
        result.dispersive = result.n.max() > result.n.min();
        warn_if_held("n", *n_, result);
        if (k_ && overlaps_simulated_range(k_->min_nm, k_->max_nm)) {
            result.k = k_->values;
            warn_if_held("k", *k_, result);
        } else if (k_) {
            result.warnings.push_back(
                fmt::format("{}: k is given from {:.6g} to {:.6g} nm only and is not used", file_,
                            k_->min_nm, k_->max_nm));
        }
        return result;
    }

private:
    struct Number {
        double value;
        SourceLocation where;
    };
    using Row = std::vector<Number>;

    void read_entry(const YamlCursor& entry, RefractiveIndexData& result) {
        YamlMap map(entry);
        const YamlCursor type_cursor =
            map.required("type", "such as 'formula 2' or 'tabulated nk'");
        const auto type = type_cursor.word();
        if (!type) return;
        if (type->starts_with("formula ")) {
            claim_n(type_cursor);
            read_formula(map, type_cursor, type->substr(8));
        } else if (*type == "tabulated nk" || *type == "tabulated n" || *type == "tabulated k") {
            const bool has_n = *type != "tabulated k";
            const bool has_k = *type != "tabulated n";
            if (has_n) claim_n(type_cursor);
            if (has_k) claim_k(type_cursor);
            read_table(map, has_n, has_k);
        } else if (*type == "tabulated n2" || type->starts_with("formula2 ")) {
            result.warnings.push_back(
                fmt::format("{}: '{}' is a nonlinear index and is not used", file_, *type));
        } else {
            type_cursor.complain(fmt::format(
                "'{}' is not a type that is known; expected 'formula 1' to 'formula 9', "
                "'tabulated nk', 'tabulated n' or 'tabulated k'",
                *type));
        }
    }

    void claim_n(const YamlCursor& at) {
        if (found_index_) at.complain("gives the index of refraction a second time");
        found_index_ = true;
    }

    void claim_k(const YamlCursor& at) {
        if (found_extinction_) at.complain("gives the extinction coefficient a second time");
        found_extinction_ = true;
    }

    // The numbers of a scalar by the rows of its text, each with its place in the file.
    std::vector<Row> numbers(const YamlCursor& cursor) {
        const auto text = cursor.word();
        if (!text) return {};
        const SourceLocation start = cursor.where();
        auto line = static_cast<std::size_t>(start.line) - 1;
        auto column = static_cast<std::size_t>(start.column) - 1;
        const bool is_block =
            line < lines_.size() && column < lines_[line].size() && lines_[line][column] == '|';
        if (is_block) {  // its text begins in the next line
            ++line;
            column = 0;
        }
        std::vector<Row> rows;
        for (const std::string& row_text : lines_of(*text)) {
            Row row;
            std::size_t position = 0;
            while ((position = row_text.find_first_not_of(" \t\r", position)) != row_text.npos) {
                const std::size_t end =
                    std::min(row_text.find_first_of(" \t\r", position), row_text.size());
                const std::string word = row_text.substr(position, end - position);
                position = end;
                SourceLocation where = start;
                if (line < lines_.size()) {
                    const std::size_t found = lines_[line].find(word, column);
                    if (found != std::string::npos) {
                        where.line = static_cast<int>(line) + 1;
                        where.column = static_cast<int>(found) + 1;
                        column = found + word.size();
                    }
                }
                row.push_back({number(word, where), where});
            }
            ++line;
            column = 0;
            if (!row.empty()) rows.push_back(std::move(row));
        }
        return rows;
    }

    double number(const std::string& word, const SourceLocation& where) {
        double value = 0.0;
        const char* begin = word.data() + (word.starts_with('+') ? 1 : 0);
        const char* end = word.data() + word.size();
        const auto [stop, error] = std::from_chars(begin, end, value);
        if (error == std::errc{} && stop == end && std::isfinite(value)) return value;
        diagnostics_.add(where, fmt::format("'{}' is not a finite number", word));
        return std::numeric_limits<double>::quiet_NaN();
    }

    // The numbers of a scalar that is one line.
    std::vector<double> list(const YamlCursor& cursor) {
        std::vector<double> values;
        for (const Row& row : numbers(cursor)) {
            for (const Number& entry : row) values.push_back(entry.value);
        }
        return values;
    }

    void read_formula(YamlMap& map, const YamlCursor& type, const std::string& number_text) {
        // "range" is what older releases of the database say.
        const YamlCursor range_cursor =
            map.has("range") ? map.optional("range")
                             : map.required("wavelength_range", "two wavelengths in micrometres");
        const YamlCursor coefficients_cursor = map.required("coefficients", "a list of numbers");
        const std::size_t complaints = diagnostics_.list().size();

        spectral::DispersionFormula formula;
        formula.coefficients = list(coefficients_cursor);
        const char* end = number_text.data() + number_text.size();
        const auto [stop, error] = std::from_chars(number_text.data(), end, formula.number);
        if (error != std::errc{} || stop != end) formula.number = 0;
        const std::string problem = formula.problem();
        if (coefficients_cursor && !problem.empty()) type.complain(problem);

        const std::vector<double> range_um = list(range_cursor);
        if (range_cursor &&
            !(range_um.size() == 2 && range_um[0] > 0.0 && range_um[0] < range_um[1])) {
            range_cursor.complain("expected two increasing wavelengths in micrometres");
        }
        if (!range_cursor || !coefficients_cursor || diagnostics_.list().size() != complaints)
            return;

        const double from_nm = 1e3 * range_um[0];
        const double to_nm = 1e3 * range_um[1];
        if (!covers_simulated_range(range_cursor, from_nm, to_nm)) return;
        try {
            n_ = Curve{formula.tabulated(std::max(from_nm, min_wavelength_nm),
                                         std::min(to_nm, max_wavelength_nm)),
                       from_nm, to_nm};
        } catch (const std::domain_error& no_index) {
            coefficients_cursor.complain(no_index.what());
        }
    }

    void read_table(YamlMap& map, bool has_n, bool has_k) {
        const YamlCursor cursor = map.required("data", "rows of numbers");
        const std::size_t complaints = diagnostics_.list().size();
        const std::size_t columns = has_n && has_k ? 3 : 2;
        std::vector<double> wavelengths_nm;
        std::vector<double> n;
        std::vector<double> k;
        for (const Row& row : numbers(cursor)) {
            if (row.size() != columns) {
                diagnostics_.add(
                    row.front().where,
                    fmt::format("{} numbers in a row; expected {}: wavelength [um]{}{}", row.size(),
                                columns, has_n ? ", n" : "", has_k ? ", k" : ""));
                continue;
            }
            const double wavelength_nm = 1e3 * row[0].value;
            if (!wavelengths_nm.empty() && wavelength_nm <= wavelengths_nm.back()) {
                diagnostics_.add(row[0].where, "wavelengths must increase");
            }
            wavelengths_nm.push_back(wavelength_nm);
            if (has_n) {
                n.push_back(row[1].value);
                if (n.back() <= 0.0) diagnostics_.add(row[1].where, "n must be positive");
            }
            if (has_k) {
                k.push_back(row[columns - 1].value);
                if (k.back() < 0.0)
                    diagnostics_.add(row[columns - 1].where, "k must not be negative");
            }
        }
        if (!cursor || diagnostics_.list().size() != complaints) return;
        if (wavelengths_nm.empty() || !(wavelengths_nm.front() > 0.0)) {
            cursor.complain("expected rows of a positive wavelength [um] and its values");
            return;
        }
        const double from_nm = wavelengths_nm.front();
        const double to_nm = wavelengths_nm.back();
        if (has_n && !covers_simulated_range(cursor, from_nm, to_nm)) return;
        if (has_n) n_ = Curve{Spectrum(wavelengths_nm, n, Outside::hold), from_nm, to_nm};
        if (has_k) k_ = Curve{Spectrum(wavelengths_nm, k, Outside::hold), from_nm, to_nm};
    }

    bool covers_simulated_range(const YamlCursor& at, double from_nm, double to_nm) {
        if (overlaps_simulated_range(from_nm, to_nm)) return true;
        at.complain(
            fmt::format("covers {:.6g} to {:.6g} nm and nothing of {} to {} nm, which is simulated",
                        from_nm, to_nm, min_wavelength_nm, max_wavelength_nm));
        return false;
    }

    void warn_if_held(const char* quantity, const Curve& curve, RefractiveIndexData& result) {
        const auto warn = [&](double from_nm, double to_nm, double end_nm) {
            result.warnings.push_back(fmt::format(
                "{}: {} is given from {:.6g} to {:.6g} nm; from {:.6g} to {:.6g} nm its value at "
                "{:.6g} nm, {:.6g}, is held",
                file_, quantity, curve.min_nm, curve.max_nm, from_nm, to_nm, end_nm,
                curve.values.at(end_nm)));
        };
        if (curve.min_nm > min_wavelength_nm) {
            warn(min_wavelength_nm, std::min(curve.min_nm, max_wavelength_nm), curve.min_nm);
        }
        if (curve.max_nm < max_wavelength_nm) {
            warn(std::max(curve.max_nm, min_wavelength_nm), max_wavelength_nm, curve.max_nm);
        }
    }

    std::filesystem::path path_;
    std::string file_;
    std::vector<std::string> lines_;  // of the file as it stands
    Diagnostics diagnostics_;
    bool found_index_ = false;
    bool found_extinction_ = false;
    std::optional<Curve> n_;
    std::optional<Curve> k_;
};

}  // namespace

RefractiveIndexData read_refractive_index(const std::filesystem::path& path) {
    return Reader(path).read();
}

}  // namespace lucerna::io
