#include "io/mesh_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <fstream>

#include "optics/geometry/polygon.h"

namespace lucerna::io {

namespace {

constexpr std::uintmax_t largest_file = std::uintmax_t{1} << 32;
constexpr std::size_t most_complaints = 20;
// Stands for the end of a line that goes on: blank, but still counted as a line.
constexpr char continued = '\v';

bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == continued || c == '\f';
}

template <typename Number>
std::optional<Number> parse(std::string_view text) {
    if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
    Number value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
    return value;
}

}  // namespace

MeshSource::MeshSource(std::filesystem::path path) : path_(std::move(path)) {
    std::error_code error;
    const std::uintmax_t size = std::filesystem::file_size(path_, error);
    if (error) throw InputError({path_.string()}, "cannot be read: " + error.message());
    if (size == 0) throw InputError({path_.string()}, "is empty; expected an OBJ, PLY or STL mesh");
    if (size > largest_file)
        throw InputError({path_.string()},
                         fmt::format("has {} bytes; a mesh file may have 4 GiB", size));
    bytes_.resize(size);
    std::ifstream file(path_, std::ios::binary);
    if (!file.read(bytes_.data(), static_cast<std::streamsize>(size)))
        throw InputError({path_.string()}, "cannot be read");
}

void MeshSource::join_continued_lines() {
    for (std::size_t i = bytes_.find('\\'); i != std::string::npos; i = bytes_.find('\\', i + 1)) {
        std::size_t end = i + 1;
        if (end < bytes_.size() && bytes_[end] == '\r') ++end;
        if (end >= bytes_.size() || bytes_[end] != '\n') continue;
        bytes_[i] = ' ';
        bytes_[end] = continued;
    }
}

Diagnostic MeshSource::at(std::size_t offset, std::string message) const {
    if (binary_) return {{path_.string()}, fmt::format("byte {}: {}", offset, message)};
    offset = std::min(offset, bytes_.size());
    const auto begin = bytes_.begin();
    const auto here = begin + static_cast<std::ptrdiff_t>(offset);
    const auto ends_line = [](char c) { return c == '\n' || c == continued; };
    const auto line = std::count_if(begin, here, ends_line) + 1;
    const auto line_begin =
        std::find_if(std::make_reverse_iterator(here), bytes_.rend(), ends_line).base();
    return {{path_.string(), static_cast<int>(line), static_cast<int>(here - line_begin) + 1},
            std::move(message)};
}

void MeshSource::complain(std::size_t offset, std::string message) {
    if (++complaints_ > most_complaints) return;
    Diagnostic complaint = at(offset, std::move(message));
    diagnostics_.add(std::move(complaint.where), std::move(complaint.message));
}

std::string MeshSource::text_at(std::size_t offset, const std::string& message) const {
    return at(offset, message).text();
}

void MeshSource::throw_if_any() {
    if (complaints_ > most_complaints)
        diagnostics_.add({path_.string()}, fmt::format("and {} more complaints of this file",
                                                       complaints_ - most_complaints));
    diagnostics_.throw_if_any();
}

MeshWord WordReader::next() {
    while (true) {
        const MeshWord word = next_in_line();
        if (!word.empty() || !next_line()) return word;
    }
}

MeshWord WordReader::next_in_line() {
    while (offset_ < text_.size() && is_blank(text_[offset_])) ++offset_;
    const std::size_t begin = offset_;
    while (offset_ < text_.size() && !is_blank(text_[offset_]) && text_[offset_] != '\n') ++offset_;
    return {text_.substr(begin, offset_ - begin), begin};
}

bool WordReader::next_line() {
    const std::size_t end = text_.find('\n', offset_);
    if (end == std::string_view::npos) {
        offset_ = text_.size();
        return false;
    }
    offset_ = end + 1;
    return offset_ < text_.size();
}

std::optional<double> parse_coordinate(std::string_view text) {
    return parse<double>(text);
}
std::optional<std::int64_t> parse_index(std::string_view text) {
    return parse<std::int64_t>(text);
}

std::string shown(std::string_view text) {
    std::string result = "\"";
    for (const char c : text.substr(0, 40)) result += c >= ' ' && c <= '~' ? c : '?';
    return result + (text.size() > 40 ? "...\"" : "\"");
}

void MeshParts::add_polygon(const std::vector<std::uint32_t>& corners, std::size_t place,
                            MeshSource& source) {
    if (corners.size() == 3) {
        triangles.push_back({corners[0], corners[1], corners[2]});
        places.push_back(place);
        return;
    }
    std::vector<Vec3> positions;
    for (const std::uint32_t corner : corners) positions.push_back(vertices[corner]);
    const auto cut = optics::triangulate_polygon(positions);
    if (!cut) {
        source.complain(place, fmt::format("this face of {} corners crosses itself or has no area",
                                           corners.size()));
        return;
    }
    for (const auto& [a, b, c] : *cut) {
        triangles.push_back({corners[a], corners[b], corners[c]});
        places.push_back(place);
    }
}

}  // namespace lucerna::io
