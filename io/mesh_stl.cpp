// STL, text and binary (3D Systems, StereoLithography Interface Specification, 1988). The stated
// normals are read past: they follow from the order of the corners.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cctype>
#include <cstring>

#include "io/mesh_source.h"
#include "optics/geometry/mesh_edges.h"

namespace lucerna::io {

namespace {

constexpr std::size_t header_bytes = 84;
constexpr std::size_t triangle_bytes = 50;

std::uint32_t little_endian(std::string_view bytes, std::size_t offset) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i)
        value |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[offset + i]))
                 << (8 * i);
    return value;
}

void add_triangle(MeshParts& parts, std::size_t place) {
    const auto last = static_cast<std::uint32_t>(parts.vertices.size());
    parts.triangles.push_back({last - 3, last - 2, last - 1});
    parts.places.push_back(place);
}

void read_binary(MeshSource& source, MeshParts& parts) {
    source.set_binary();
    const std::string_view bytes = source.bytes();
    const std::uint64_t stated = little_endian(bytes, 80);
    const std::uint64_t held = (bytes.size() - header_bytes) / triangle_bytes;
    if (stated > held) {
        source.complain(
            80, fmt::format("{} triangles are stated, but the file ends after {}", stated, held));
        return;
    }
    if (bytes.size() > header_bytes + stated * triangle_bytes)
        parts.warnings.push_back(source.text_at(header_bytes + stated * triangle_bytes,
                                                "the bytes from here on are not triangles"));
    parts.vertices.reserve(3 * stated);
    for (std::uint64_t i = 0; i < stated; ++i) {
        const std::size_t place = header_bytes + i * triangle_bytes;
        for (std::size_t corner = 0; corner < 3; ++corner) {
            Vec3 p;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const std::size_t offset = place + 12 + 12 * corner + 4 * axis;
                const auto value = std::bit_cast<float>(little_endian(bytes, offset));
                if (!std::isfinite(value)) source.complain(offset, "is not a finite coordinate");
                p[static_cast<Eigen::Index>(axis)] = static_cast<double>(value);
            }
            parts.vertices.push_back(p);
        }
        add_triangle(parts, place);
    }
}

bool same_word(std::string_view word, std::string_view lower_case) {
    return std::equal(
        word.begin(), word.end(), lower_case.begin(), lower_case.end(),
        [](char a, char b) { return std::tolower(static_cast<unsigned char>(a)) == b; });
}

/// Reads the words of one text file; a complaint ends it, as what follows has lost its meaning.
class TextReader {
public:
    TextReader(MeshSource& source, MeshParts& parts)
        : source_(source), parts_(parts), words_(source.bytes(), 0) {}

    void read() {
        MeshWord word = words_.next();
        while (!word.empty()) {
            if (!is(word, "solid")) return;
            words_.next_line();  // the rest of the line is a name
            for (word = words_.next(); same_word(word.text, "facet"); word = words_.next())
                if (!read_facet(word.offset)) return;
            if (!is(word, "endsolid", "facet or endsolid")) return;
            words_.next_line();
            word = words_.next();
        }
    }

private:
    bool read_facet(std::size_t place) {
        if (!expect("normal")) return false;
        for (int i = 0; i < 3; ++i) words_.next();
        if (!expect("outer") || !expect("loop")) return false;
        for (int corner = 0; corner < 3; ++corner)
            if (!expect("vertex") || !read_position()) return false;
        if (!expect("endloop") || !expect("endfacet")) return false;
        add_triangle(parts_, place);
        return true;
    }

    bool read_position() {
        Vec3 p;
        for (int axis = 0; axis < 3; ++axis) {
            const MeshWord word = words_.next();
            const auto number = parse_coordinate(word.text);
            if (!number || !std::isfinite(*number)) {
                source_.complain(word.offset, found(word) + "; expected a finite coordinate");
                return false;
            }
            p[axis] = *number;
        }
        parts_.vertices.push_back(p);
        return true;
    }

    static std::string found(const MeshWord& word) {
        return word.empty() ? "the file ends here" : "found " + shown(word.text);
    }

    bool is(const MeshWord& word, std::string_view expected, std::string_view choice = {}) {
        if (same_word(word.text, expected)) return true;
        source_.complain(word.offset, fmt::format("{}; expected {}", found(word),
                                                  choice.empty() ? expected : choice));
        return false;
    }

    bool expect(std::string_view expected) { return is(words_.next(), expected); }

    MeshSource& source_;
    MeshParts& parts_;
    WordReader words_;
};

/// One vertex for all corners at the same position.
void weld(MeshParts& parts) {
    const std::vector<std::uint32_t> first = optics::weld_vertices(parts.vertices);
    std::vector<std::uint32_t> index(parts.vertices.size());
    std::vector<Vec3> vertices;
    for (std::uint32_t i = 0; i < first.size(); ++i) {
        if (first[i] == i) {
            index[i] = static_cast<std::uint32_t>(vertices.size());
            vertices.push_back(parts.vertices[i]);
        }
    }
    for (auto& triangle : parts.triangles)
        for (std::uint32_t& vertex : triangle) vertex = index[first[vertex]];
    parts.vertices = std::move(vertices);
}

}  // namespace

MeshParts read_stl(MeshSource& source) {
    MeshParts parts;
    const std::string_view bytes = source.bytes();
    // Some binary files begin with "solid" too: their size tells.
    const bool size_fits =
        bytes.size() >= header_bytes &&
        bytes.size() == header_bytes + triangle_bytes * std::uint64_t{little_endian(bytes, 80)};
    const bool begins_as_text = same_word(WordReader(bytes, 0).next().text, "solid");
    if (begins_as_text && !size_fits) {
        TextReader(source, parts).read();
    } else if (bytes.size() >= header_bytes) {
        read_binary(source, parts);
    } else {
        source.complain(0,
                        "is neither a text STL, which begins with \"solid\", nor a binary one, "
                        "which has 84 bytes or more");
    }
    source.throw_if_any();
    weld(parts);
    return parts;
}

}  // namespace lucerna::io
