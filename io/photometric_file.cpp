#include "io/photometric_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>

#include "io/eulumdat.h"
#include "io/ies.h"
#include "io/photometric_reading.h"

namespace lucerna {
namespace {

constexpr std::size_t max_file_bytes = 64u << 20;
constexpr std::size_t max_messages = 20;

bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\f' || c == '\v';
}

// Length of the UTF-8 sequence that starts at `i`, or 0 if the bytes are none (RFC 3629).
std::size_t utf8_length(const std::string& bytes, std::size_t i) {
    const auto byte = [&](std::size_t k) {
        return k < bytes.size() ? static_cast<unsigned char>(bytes[k]) : 0u;
    };
    const unsigned first = byte(i);
    const std::size_t length = first < 0x80                    ? 1
                               : first >= 0xC2 && first < 0xE0 ? 2
                               : first >= 0xE0 && first < 0xF0 ? 3
                               : first >= 0xF0 && first < 0xF5 ? 4
                                                               : 0;
    for (std::size_t k = 1; k < length; ++k) {
        if ((byte(i + k) & 0xC0) != 0x80) return 0;
    }
    if ((first == 0xE0 && byte(i + 1) < 0xA0) || (first == 0xED && byte(i + 1) > 0x9F) ||
        (first == 0xF0 && byte(i + 1) < 0x90) || (first == 0xF4 && byte(i + 1) > 0x8F)) {
        return 0;
    }
    return length;
}

bool is_utf8(const std::string& bytes) {
    for (std::size_t i = 0; i < bytes.size();) {
        const std::size_t length = utf8_length(bytes, i);
        if (length == 0) return false;
        i += length;
    }
    return true;
}

// The characters 0x80 to 0x9F of Windows-1252; 0: not assigned. The others are those of Unicode.
constexpr unsigned windows_1252[32] = {
    0x20AC, 0,      0x201A, 0x0192, 0x201E, 0x2026, 0x2020, 0x2021, 0x02C6, 0x2030, 0x0160,
    0x2039, 0x0152, 0,      0x017D, 0,      0,      0x2018, 0x2019, 0x201C, 0x201D, 0x2022,
    0x2013, 0x2014, 0x02DC, 0x2122, 0x0161, 0x203A, 0x0153, 0,      0x017E, 0x0178};

std::string from_windows_1252(const std::string& bytes) {
    std::string text;
    for (const char c : bytes) {
        unsigned code = static_cast<unsigned char>(c);
        if (code >= 0x80 && code < 0xA0) code = windows_1252[code - 0x80];
        if (code >= 0x80 && code < 0x800) {
            text += static_cast<char>(0xC0 | (code >> 6));
            text += static_cast<char>(0x80 | (code & 0x3F));
        } else if (code >= 0x800) {
            text += static_cast<char>(0xE0 | (code >> 12));
            text += static_cast<char>(0x80 | ((code >> 6) & 0x3F));
            text += static_cast<char>(0x80 | (code & 0x3F));
        } else {
            text += code == 0 ? '?' : static_cast<char>(code);
        }
    }
    return text;
}

std::string read_bytes(const std::filesystem::path& path) {
    std::error_code error;
    if (std::filesystem::is_directory(path, error)) {
        throw InputError({path.string()}, "is a folder; expected an IES or EULUMDAT file");
    }
    const auto size = std::filesystem::file_size(path, error);
    std::ifstream stream(path, std::ios::binary);
    if (error || !stream) throw InputError({path.string()}, "cannot be read");
    if (size > max_file_bytes) {
        throw InputError({path.string()},
                         fmt::format("has {} MiB; expected a photometric file of at most {} MiB",
                                     size >> 20, max_file_bytes >> 20));
    }
    std::string bytes(static_cast<std::size_t>(size), '\0');
    stream.read(bytes.data(), static_cast<std::streamsize>(size));
    bytes.resize(static_cast<std::size_t>(std::max<std::streamsize>(0, stream.gcount())));
    return bytes;
}

double largest(const std::vector<std::vector<double>>& values) {
    double result = 0.0;
    for (const auto& plane : values) {
        for (const double value : plane) result = std::max(result, value);
    }
    return result;
}

}  // namespace

SourceLocation TextFile::at(std::size_t line_index, std::size_t column_index) const {
    return {path.string(), static_cast<int>(line_index + 1), static_cast<int>(column_index + 1)};
}

TextFile read_text_file(const std::filesystem::path& path) {
    std::string bytes = read_bytes(path);
    if (bytes.starts_with("\xFF\xFE") || bytes.starts_with("\xFE\xFF")) {
        throw InputError({path.string(), 1, 1}, "is UTF-16 text; expected UTF-8 or Windows-1252");
    }
    if (bytes.starts_with("\xEF\xBB\xBF")) bytes.erase(0, 3);
    while (!bytes.empty() && (bytes.back() == '\x1A' || bytes.back() == '\0')) bytes.pop_back();
    if (bytes.empty()) throw InputError({path.string(), 1, 1}, "is empty");
    if (bytes.find('\0') != std::string::npos) {
        throw InputError({path.string(), 1, 1}, "is not text (it has zero bytes)");
    }
    if (!is_utf8(bytes)) bytes = from_windows_1252(bytes);

    TextFile file{path, {}};
    std::size_t start = 0;
    while (start < bytes.size()) {  // lines end in LF, CR LF or CR
        const std::size_t end = std::min(bytes.find_first_of("\r\n", start), bytes.size());
        file.lines.push_back(bytes.substr(start, end - start));
        const bool pair = end + 1 < bytes.size() && bytes[end] == '\r' && bytes[end + 1] == '\n';
        start = end + (pair ? 2 : 1);
    }
    return file;
}

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
    while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
    return text;
}

std::string in_quotes(std::string_view text) {
    constexpr std::size_t most = 40;
    if (text.size() <= most) return fmt::format("\"{}\"", text);
    std::size_t end = most;
    while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end;
    return fmt::format("\"{}...\"", text.substr(0, end));
}

std::optional<double> parse_number(std::string_view text) {
    if (text.starts_with('+')) {
        text.remove_prefix(1);
        if (text.starts_with('-')) return std::nullopt;
    }
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) {
        return std::nullopt;
    }
    return value;
}

std::vector<Word> split_words(const TextFile& file, std::size_t first_line,
                              std::string_view separators) {
    std::vector<Word> words;
    for (std::size_t line = first_line; line < file.lines.size(); ++line) {
        const std::string_view text = file.lines[line];
        const auto separates = [&](char c) {
            return is_blank(c) || separators.find(c) != std::string_view::npos;
        };
        for (std::size_t i = 0; i < text.size();) {
            if (separates(text[i])) {
                ++i;
                continue;
            }
            std::size_t end = i;
            while (end < text.size() && !separates(text[end])) ++end;
            words.push_back({text.substr(i, end - i), line, i});
            i = end;
        }
    }
    return words;
}

void ErrorList::add(std::size_t line, std::size_t column, std::string message) {
    if (++count_ <= max_messages) diagnostics_.add(file_.at(line, column), std::move(message));
}

void ErrorList::throw_if_any() {
    if (count_ > max_messages) {
        diagnostics_.add({file_.path.string()},
                         fmt::format("and {} more errors", count_ - max_messages));
    }
    diagnostics_.throw_if_any();
}

PlaneTable mirrored_at_last_plane(const PlaneTable& table) {
    PlaneTable result = table;
    const double mirror_deg = table.c_deg.back();
    for (std::size_t i = table.c_deg.size() - 1; i-- > 0;) {
        result.add_plane(2.0 * mirror_deg - table.c_deg[i], table.values[i]);
    }
    return result;
}

PlaneTable mirrored_at_c90(const PlaneTable& table) {
    // I(C) = I(180 - C). Every plane counts at its own angle and at its image, both in [0, 360).
    std::vector<std::pair<double, std::size_t>> planes;
    for (std::size_t i = 0; i < table.c_deg.size(); ++i) {
        for (const double angle_deg : {table.c_deg[i], 180.0 - table.c_deg[i]}) {
            planes.emplace_back(angle_deg < 0.0 ? angle_deg + 360.0 : angle_deg, i);
        }
    }
    std::sort(planes.begin(), planes.end());
    PlaneTable result{{}, table.gamma_deg, {}};
    for (const auto& [angle_deg, i] : planes) {
        if (result.c_deg.empty() || angle_deg > result.c_deg.back()) {
            result.add_plane(angle_deg, table.values[i]);
        }
    }
    if (result.c_deg.front() > 0.0) {  // no plane at 0: between the last plane and the first
        const double before_deg = 360.0 - result.c_deg.back();
        const double share = before_deg / (before_deg + result.c_deg.front());
        std::vector<double> plane = result.values.back();
        for (std::size_t g = 0; g < plane.size(); ++g) {
            plane[g] += share * (result.values.front()[g] - plane[g]);
        }
        result.c_deg.insert(result.c_deg.begin(), 0.0);
        result.values.insert(result.values.begin(), std::move(plane));
    }
    result.add_plane(360.0, std::vector<double>(result.values.front()));
    return result;
}

std::vector<std::string> contradictions(const PlaneTable& full_circle) {
    std::vector<std::string> found;
    const double tolerance = 0.01 * largest(full_circle.values);
    const auto check_pole = [&](double gamma_deg, std::size_t g) {
        if (full_circle.gamma_deg[g] != gamma_deg) return;
        double low = infinity;
        double high = 0.0;
        for (const auto& plane : full_circle.values) {
            low = std::min(low, plane[g]);
            high = std::max(high, plane[g]);
        }
        if (high - low > tolerance) {
            found.push_back(
                fmt::format("intensities at gamma = {} differ between the C planes, "
                            "from {:.6g} to {:.6g} cd, though it is one direction",
                            gamma_deg, low, high));
        }
    };
    check_pole(0.0, 0);
    check_pole(180.0, full_circle.gamma_deg.size() - 1);
    if (full_circle.c_deg.size() > 1) {
        double gap = 0.0;
        for (std::size_t g = 0; g < full_circle.gamma_deg.size(); ++g) {
            gap = std::max(gap,
                           std::abs(full_circle.values.front()[g] - full_circle.values.back()[g]));
        }
        if (gap > tolerance) {
            found.push_back(
                fmt::format("planes C0 and C360 differ by up to {:.6g} cd, though they "
                            "are one plane",
                            gap));
        }
    }
    return found;
}

PhotometricFile photometric_file(const TextFile& file, const PlaneTable& table, std::size_t line) {
    const double max_cd = largest(table.values);
    if (!(max_cd > 0.0)) {
        throw InputError(file.at(line), "all intensities are 0; expected a luminaire that emits");
    }
    // Far beyond any source, and still far from overflow in the integrals.
    if (!(max_cd < 1e30)) {
        throw InputError(
            file.at(line),
            fmt::format("an intensity of {:.3g} cd; expected less than 1e30 cd", max_cd));
    }
    try {
        PhotometricFile result(
            optics::IntensityDistribution(table.c_deg, table.gamma_deg, table.values));
        result.integrated_flux_lm = result.intensity.luminous_flux_lm();
        result.downward_fraction =
            result.intensity.zonal_flux_lm(0.0, 90.0) / result.integrated_flux_lm;
        result.deviations = contradictions(table);
        return result;
    } catch (const std::invalid_argument& problem) {
        throw InputError(file.at(line), problem.what());
    }
}

PhotometricFile read_photometric_file(const std::filesystem::path& path, int lamp_set) {
    const TextFile file = read_text_file(path);
    if (looks_like_ies(file)) return read_ies(file);
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    const bool named_ies = extension == ".ies";
    const bool ies_header = file.lines.front().find("LM-63") != std::string::npos ||
                            trimmed(file.lines.front()).starts_with("IESNA");
    if (named_ies || ies_header) return read_ies(file);  // it will say that TILT= is missing
    if (extension == ".ldt") return read_eulumdat(file, lamp_set);
    // Neither by name nor by a TILT= line: the third line of EULUMDAT is a symmetry from 0 to 4.
    if (file.lines.size() > 26) {
        const auto symmetry = parse_number(trimmed(file.lines[2]));
        if (symmetry && *symmetry >= 0.0 && *symmetry <= 4.0) return read_eulumdat(file, lamp_set);
    }
    throw InputError(
        {path.string(), 1, 1},
        "is neither IES LM-63 (it has no line TILT=) nor EULUMDAT (its third line is no "
        "symmetry indicator from 0 to 4)");
}

}  // namespace lucerna
