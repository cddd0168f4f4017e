#include "io/bsdf_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace lucerna::io {

namespace {

using optics::BsdfGrid;
using optics::BsdfTable;
using optics::MeasuredBsdf;
using optics::MeasuredParts;
using optics::Side;
using optics::TabulatedBsdf;

constexpr std::string_view first_line = "# lucerna bsdf table 1";
constexpr std::array<std::string_view, 4> part_names{"reflection front", "reflection back",
                                                     "transmission front", "transmission back"};
constexpr std::string_view all_parts =
    "reflection front, reflection back, transmission front or transmission back";

/// The numbers of a row, in the order in which a grid is stored.
enum Column : std::size_t { theta_in, theta_out, delta_phi, wavelength, bsdf, column_count };
struct ColumnRule {
    std::string_view name;
    bool required;
    double least, most;
};
constexpr std::array<ColumnRule, column_count> rules{{{"theta_in_deg", true, 0.0, 90.0},
                                                      {"theta_out_deg", true, 0.0, 90.0},
                                                      {"delta_phi_deg", false, 0.0, 360.0},
                                                      {"wavelength_nm", false, 1.0, 1e6},
                                                      {"bsdf_per_sr", true, 0.0, 1e30}}};

struct Row {
    std::array<double, column_count> value{};
    std::size_t line;
};

double radians(double degrees) {
    return degrees * pi / 180.0;
}

std::vector<std::string_view> cells_of(std::string_view line) {
    std::vector<std::string_view> cells;
    for (std::size_t begin = 0;;) {
        const std::size_t end = std::min(line.find(',', begin), line.size());
        cells.push_back(trimmed(line.substr(begin, end - begin)));
        if (end == line.size()) return cells;
        begin = end + 1;
    }
}

class TableReader {
public:
    explicit TableReader(const TextFile& file) : file_(file) {}

    MeasuredBsdf read() {
        if (trimmed(file_.lines.front()) != first_line) {
            throw InputError(file_.at(0),
                             fmt::format("is no BSDF file; expected XML or the first line "
                                         "\"{}\"",
                                         first_line));
        }
        for (std::size_t line = 1; line < file_.lines.size(); ++line) {
            const std::string_view text = trimmed(file_.lines[line]);
            if (text.empty() || text.starts_with('#')) continue;
            if (text.starts_with("black:")) {
                read_black(line, text.substr(6));
            } else if (columns_.empty()) {
                read_header(line, cells_of(text));
            } else {
                read_row(line, cells_of(text));
            }
            if (errors_.list().size() >= 20) break;  // the rest is likely wrong in the same way
        }
        errors_.throw_if_any();
        MeasuredParts<BsdfTable> parts;
        for (std::size_t part = 0; part < part_names.size(); ++part) {
            auto& target = (part < 2 ? parts.reflection : parts.transmission)[part % 2];
            if (rows_[part].empty() != black_[part]) {
                errors_.add(file_.at(0),
                            black_[part]
                                ? fmt::format("{} is declared black but has rows", part_names[part])
                                : fmt::format("{0} is missing; expected rows for it, or the "
                                              "line \"black: {0}\"",
                                              part_names[part]));
            } else if (!black_[part]) {
                target = table(part);
            }
        }
        errors_.throw_if_any();
        MeasuredBsdf measured{TabulatedBsdf(std::move(parts))};
        check_energy(std::get<TabulatedBsdf>(measured.data));
        errors_.throw_if_any();
        measured.warnings = std::move(warnings_);
        return measured;
    }

private:
    std::optional<std::size_t> part_of(std::string_view name) const {
        const auto found = std::ranges::find(part_names, name);
        if (found == part_names.end()) return std::nullopt;
        return static_cast<std::size_t>(found - part_names.begin());
    }

    void read_black(std::size_t line, std::string_view list) {
        for (const std::string_view name : cells_of(list)) {
            if (const auto part = part_of(name)) {
                black_[*part] = true;
            } else {
                errors_.add(file_.at(line), fmt::format("\"{}\" is no part of a BSDF; expected {}",
                                                        name, all_parts));
            }
        }
    }

    void read_header(std::size_t line, const std::vector<std::string_view>& cells) {
        std::array<bool, column_count> seen{};
        if (cells.front() != "part") {
            errors_.add(file_.at(line), fmt::format("the first column is \"{}\"; expected \"part\"",
                                                    cells.front()));
        }
        for (std::size_t i = 1; i < cells.size(); ++i) {
            const auto rule = std::ranges::find(rules, cells[i], &ColumnRule::name);
            const auto column = static_cast<std::size_t>(rule - rules.begin());
            if (rule == rules.end() || seen[column]) {
                errors_.add(
                    file_.at(line),
                    fmt::format("the column \"{}\" is unknown or given twice; expected part, "
                                "theta_in_deg, theta_out_deg, delta_phi_deg (may be left out), "
                                "wavelength_nm (may be left out), bsdf_per_sr",
                                cells[i]));
            } else {
                seen[column] = true;
            }
            columns_.push_back(static_cast<Column>(column));
        }
        for (std::size_t column = 0; column < column_count; ++column) {
            if (rules[column].required && !seen[column]) {
                errors_.add(file_.at(line),
                            fmt::format("the column {} is missing", rules[column].name));
            }
        }
        errors_.throw_if_any();  // without the columns no row has a meaning
    }

    void read_row(std::size_t line, const std::vector<std::string_view>& cells) {
        if (cells.size() != columns_.size() + 1) {
            errors_.add(file_.at(line), fmt::format("has {} columns; expected {}", cells.size(),
                                                    columns_.size() + 1));
            return;
        }
        const auto part = part_of(cells.front());
        if (!part) {
            errors_.add(file_.at(line), fmt::format("\"{}\" is no part of a BSDF; expected {}",
                                                    cells.front(), all_parts));
            return;
        }
        Row row{{}, line};
        for (std::size_t i = 0; i < columns_.size(); ++i) {
            const ColumnRule& rule = rules[columns_[i]];
            const auto value = parse_number(cells[i + 1]);
            if (!value || *value < rule.least || *value > rule.most) {
                const auto column =
                    static_cast<std::size_t>(cells[i + 1].data() - file_.lines[line].data());
                errors_.add(file_.at(line, column),
                            fmt::format("{} is \"{}\"; expected a number from {} to {}", rule.name,
                                        cells[i + 1], rule.least, rule.most));
                continue;
            }
            row.value[columns_[i]] = *value;
        }
        rows_[*part].push_back(row);
    }

    /// The grid of a part; complains if rows are missing or double.
    std::optional<BsdfTable> table(std::size_t part) {
        auto& rows = rows_[part];
        std::ranges::stable_sort(rows, [](const Row& a, const Row& b) {
            return std::lexicographical_compare(a.value.begin(), a.value.begin() + bsdf,
                                                b.value.begin(), b.value.begin() + bsdf);
        });
        std::array<std::vector<double>, bsdf> axes;
        double grid_size = 1.0;
        for (std::size_t axis = 0; axis < axes.size(); ++axis) {
            for (const Row& row : rows) axes[axis].push_back(row.value[axis]);
            std::ranges::sort(axes[axis]);
            axes[axis].erase(std::unique(axes[axis].begin(), axes[axis].end()), axes[axis].end());
            grid_size *= static_cast<double>(axes[axis].size());
        }
        const auto& phi = axes[delta_phi];
        if (phi.front() != 0.0 || (phi.size() > 1 && phi.back() != 180.0 && phi.back() != 360.0)) {
            errors_.add(
                file_.at(rows.front().line),
                fmt::format("{}: delta_phi_deg reaches from {} to {}; expected from 0 to 180 "
                            "(mirror symmetry), from 0 to 360, or 0 alone",
                            part_names[part], phi.front(), phi.back()));
        }
        if (!full_grid(part, axes, grid_size)) return std::nullopt;
        if (!errors_.empty()) return std::nullopt;

        warn_of_held_ends(part, axes);
        BsdfGrid grid;
        for (const double x : axes[theta_in]) grid.theta_in_rad.push_back(radians(x));
        for (const double x : axes[theta_out]) grid.theta_out_rad.push_back(radians(x));
        for (const double x : axes[delta_phi]) grid.delta_phi_rad.push_back(radians(x));
        grid.wavelength_nm = axes[wavelength];
        for (const Row& row : rows) grid.bsdf_per_sr.push_back(row.value[bsdf]);
        return BsdfTable(grid);
    }

    /// Rows are sorted: the first that differs from its place in the grid is double or follows a
    /// gap.
    bool full_grid(std::size_t part, const std::array<std::vector<double>, bsdf>& axes,
                   double grid_size) {
        const auto& rows = rows_[part];
        for (std::size_t i = 0; i < rows.size(); ++i) {
            if (i > 0 && std::equal(rows[i].value.begin(), rows[i].value.begin() + bsdf,
                                    rows[i - 1].value.begin())) {
                errors_.add(file_.at(rows[i].line),
                            fmt::format("repeats the angles and wavelength of line {}",
                                        rows[i - 1].line + 1));
                return false;
            }
            std::size_t rest = i;
            for (std::size_t axis = axes.size(); axis-- > 0;) {
                if (axes[axis][rest % axes[axis].size()] != rows[i].value[axis]) {
                    errors_.add(
                        file_.at(rows[i].line),
                        fmt::format("{} is no full grid: it has {} rows for {} theta_in x {} "
                                    "theta_out x {} delta_phi x {} wavelengths = {:.0f}; the first "
                                    "gap is before this row",
                                    part_names[part], rows.size(), axes[theta_in].size(),
                                    axes[theta_out].size(), axes[delta_phi].size(),
                                    axes[wavelength].size(), grid_size));
                    return false;
                }
                rest /= axes[axis].size();
            }
        }
        if (static_cast<double>(rows.size()) != grid_size) {
            errors_.add(
                file_.at(rows.back().line),
                fmt::format("{} is no full grid: {} rows of {:.0f}; the last ones are missing",
                            part_names[part], rows.size(), grid_size));
            return false;
        }
        return true;
    }

    void warn_of_held_ends(std::size_t part, const std::array<std::vector<double>, bsdf>& axes) {
        for (const Column axis : {theta_in, theta_out}) {
            const auto& x = axes[axis];
            if (x.front() == 0.0 && x.back() == 90.0) continue;
            warn(fmt::format(
                "{}: {} reaches from {} to {}; the values at the ends are held to 0 and "
                "90 deg",
                part_names[part], rules[axis].name, x.front(), x.back()));
        }
        const auto& nm = axes[wavelength];
        if (nm.size() > 1 && (nm.front() > 380.0 || nm.back() < 780.0)) {
            warn(fmt::format(
                "{}: wavelengths reach from {} to {} nm; the values at the ends are held",
                part_names[part], nm.front(), nm.back()));
        }
    }

    void check_energy(const TabulatedBsdf& tabulated) {
        for (const Side light : {Side::front, Side::back}) {
            double most = 0.0, at_rad = 0.0;
            // The sum is linear between the nodes of either part, hence largest at one of them.
            for (const BsdfTable* angles :
                 {tabulated.parts().reflected(light), tabulated.parts().transmitted(light)}) {
                for (const BsdfTable* spectrum :
                     {tabulated.parts().reflected(light), tabulated.parts().transmitted(light)}) {
                    if (!angles || !spectrum) continue;
                    for (const double theta_rad : angles->theta_in_rad()) {
                        for (const double nm : spectrum->wavelength_nm()) {
                            const double sum =
                                tabulated.directional_hemispherical(light, theta_rad, nm);
                            if (sum > most) most = sum, at_rad = theta_rad;
                        }
                    }
                }
            }
            if (most <= 1.0) continue;
            const std::string found =
                fmt::format("light from the {} at {:.4g} deg is scattered to {:.4f} of itself",
                            light == Side::front ? "front" : "back", at_rad * 180.0 / pi, most);
            if (most <= max_directional_hemispherical) {
                warn(found);
            } else {
                const auto& reflection = rows_[static_cast<std::size_t>(light)];
                const auto& rows =
                    reflection.empty() ? rows_[2 + static_cast<std::size_t>(light)] : reflection;
                errors_.add(file_.at(rows.front().line),
                            fmt::format("{}; expected at most {} for reflection and transmission "
                                        "together",
                                        found, max_directional_hemispherical));
            }
        }
    }

    void warn(const std::string& what) {
        warnings_.push_back(fmt::format("{}: {}", file_.path.string(), what));
    }

    const TextFile& file_;
    Diagnostics errors_;
    std::vector<std::string> warnings_;
    std::vector<Column> columns_;
    std::array<std::vector<Row>, 4> rows_;
    std::array<bool, 4> black_{};
};

}  // namespace

optics::MeasuredBsdf read_bsdf_table(const TextFile& file) {
    return TableReader(file).read();
}

}  // namespace lucerna::io
