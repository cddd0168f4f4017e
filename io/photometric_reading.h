// What the readers of IES LM-63 and EULUMDAT have in common.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/diagnostics.h"
#include "io/photometric_file.h"

namespace lucerna {

/// A text file as UTF-8 lines without line ends, byte order mark and trailing end-of-file marks.
struct TextFile {
    std::filesystem::path path;
    std::vector<std::string> lines;

    SourceLocation at(std::size_t line_index, std::size_t column_index = 0) const;
};

/// Reads UTF-8, or Windows-1252 where the bytes are not UTF-8. Throws InputError if the file cannot
/// be read, is empty, binary, or larger than 64 MiB.
TextFile read_text_file(const std::filesystem::path& path);

std::string_view trimmed(std::string_view text);
/// Quoted for a message, shortened to 40 characters.
std::string in_quotes(std::string_view text);

/// A finite decimal number, or nothing; independent of the locale.
std::optional<double> parse_number(std::string_view text);

/// A word of the text and where it begins, counted from 0.
struct Word {
    std::string_view text;
    std::size_t line = 0;
    std::size_t column = 0;
};

/// Words of the lines from `first_line` on, separated by blanks or one of `separators`.
std::vector<Word> split_words(const TextFile& file, std::size_t first_line,
                              std::string_view separators);

/// Collects complaints, but no more than a screenful of the same kind.
class ErrorList {
public:
    explicit ErrorList(const TextFile& file) : file_(file) {}
    void add(std::size_t line, std::size_t column, std::string message);
    bool empty() const { return count_ == 0; }
    void throw_if_any();

private:
    const TextFile& file_;
    Diagnostics diagnostics_;
    std::size_t count_ = 0;
};

/// Intensities of the planes of a file, on the way to the full circle.
struct PlaneTable {
    std::vector<double> c_deg, gamma_deg;
    std::vector<std::vector<double>> values;  // [c][gamma]

    void add_plane(double angle_deg, const std::vector<double>& plane) {
        c_deg.push_back(angle_deg);
        values.push_back(plane);
    }
};

/// Planes from 0 to 90 mirrored to 0..180, from 0 to 180 mirrored to 0..360.
PlaneTable mirrored_at_last_plane(const PlaneTable& table);

/// Planes from -90 (270) to 90, or 90 to 270, mirrored at the plane C90-C270 to 0..360.
/// @param c_deg of `table`  increasing from -90 to 90 or from 90 to 270
PlaneTable mirrored_at_c90(const PlaneTable& table);

/// Contradictions within a full table: poles and the planes 0 and 360 that differ by more than 1 %.
std::vector<std::string> contradictions(const PlaneTable& full_circle);

/// The result with what follows from the intensities filled in; `table` in cd.
/// Throws InputError at `place` if no intensity is above zero.
PhotometricFile photometric_file(const TextFile& file, const PlaneTable& table, std::size_t line);

}  // namespace lucerna
