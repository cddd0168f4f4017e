// The bytes of a mesh file, the places in them, and what the readers of its formats hand over.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/diagnostics.h"
#include "core/vector.h"

namespace lucerna::io {

/// A whole file in memory, with the complaints about it. A place is a byte offset: it is shown as
/// line and column in a text file and as itself in a binary one.
class MeshSource {
public:
    /// Throws InputError if the file cannot be read, is empty or larger than 4 GiB.
    explicit MeshSource(std::filesystem::path path);

    std::string_view bytes() const { return bytes_; }
    const std::filesystem::path& path() const { return path_; }
    void set_binary() { binary_ = true; }
    /// Makes a line go on after a backslash at its end, without moving any place.
    void join_continued_lines();

    void complain(std::size_t offset, std::string message);
    /// "mesh.obj:12: message" or "mesh.stl: byte 84: message".
    std::string text_at(std::size_t offset, const std::string& message) const;
    /// Throws InputError if anything was complained about: the first 20 complaints and their
    /// number.
    void throw_if_any();

private:
    Diagnostic at(std::size_t offset, std::string message) const;

    std::filesystem::path path_;
    std::string bytes_;
    bool binary_ = false;
    Diagnostics diagnostics_;
    std::size_t complaints_ = 0;
};

/// A word of a text file and where it begins.
struct MeshWord {
    std::string_view text;
    std::size_t offset = 0;

    bool empty() const { return text.empty(); }
};

/// Walks through the words of a text.
class WordReader {
public:
    WordReader(std::string_view text, std::size_t offset) : text_(text), offset_(offset) {}

    /// Next word, or an empty one at the end of the text.
    MeshWord next();
    /// Next word of this line, or an empty one at its end; the line's end is not passed.
    MeshWord next_in_line();
    /// Moves to the beginning of the next line; false at the end of the text.
    bool next_line();
    std::size_t offset() const { return offset_; }

private:
    std::string_view text_;
    std::size_t offset_;
};

/// A decimal number, finite or not, or nothing; independent of the locale.
std::optional<double> parse_coordinate(std::string_view text);
/// An integer, or nothing.
std::optional<std::int64_t> parse_index(std::string_view text);
/// For a message: in quotes, shortened, unprintable bytes replaced.
std::string shown(std::string_view text);

/// Triangles in the units of the file, each with the place where it is stated.
struct MeshParts {
    std::vector<Vec3> vertices;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::vector<std::size_t> places;
    std::vector<std::string> warnings;

    /// Adds a polygon of three corners or more; complains if it cannot be cut into triangles.
    void add_polygon(const std::vector<std::uint32_t>& corners, std::size_t place,
                     MeshSource& source);
};

MeshParts read_obj(MeshSource& source);
MeshParts read_ply(MeshSource& source);
MeshParts read_stl(MeshSource& source);

}  // namespace lucerna::io
