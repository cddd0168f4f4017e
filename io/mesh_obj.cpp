// Wavefront OBJ ("Advanced Visualizer" manual, appendix B1): polygons; what only matters to
// renderers of images is read past.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "io/mesh_source.h"

namespace lucerna::io {

namespace {

using std::string_view_literals::operator""sv;

constexpr std::array read_past{"vt"sv,       "vn"sv,       "vp"sv,         "g"sv,        "o"sv,
                               "s"sv,        "mg"sv,       "l"sv,          "p"sv,        "mtllib"sv,
                               "usemtl"sv,   "maplib"sv,   "usemap"sv,     "bevel"sv,    "lod"sv,
                               "c_interp"sv, "d_interp"sv, "shadow_obj"sv, "trace_obj"sv};
constexpr std::array free_form{"cstype"sv, "deg"sv,  "bmat"sv, "step"sv, "curv"sv,
                               "curv2"sv,  "surf"sv, "parm"sv, "trim"sv, "hole"sv,
                               "scrv"sv,   "sp"sv,   "end"sv,  "con"sv};

template <typename List>
bool holds(const List& list, std::string_view word) {
    return std::find(list.begin(), list.end(), word) != list.end();
}

/// A corner as a face states it: resolved to count from 0, but perhaps of a vertex yet to come.
struct Corner {
    std::int64_t vertex;
    std::size_t place;
};

struct Face {
    std::size_t first_corner;
    std::size_t corner_count;
    std::size_t place;
};

void read_vertex(WordReader& words, std::size_t place, MeshSource& source,
                 std::vector<Vec3>& vertices) {
    // x y z, then a weight or a colour in some files
    Vec3 p = Vec3::Zero();
    int count = 0;
    for (MeshWord word = words.next_in_line(); !word.empty() && word.text[0] != '#';
         word = words.next_in_line()) {
        const auto number = parse_coordinate(word.text);
        if (!number || !std::isfinite(*number)) {
            source.complain(word.offset,
                            fmt::format("{} is not a finite number", shown(word.text)));
            count = 3;  // the number of coordinates is not the trouble
            break;
        }
        if (count < 3) p[count] = *number;
        ++count;
    }
    if (count < 3) source.complain(place, fmt::format("a vertex has {} of 3 coordinates", count));
    vertices.push_back(p);
}

void read_face(WordReader& words, std::size_t place, std::size_t vertex_count, MeshSource& source,
               std::vector<Corner>& corners, std::vector<Face>& faces) {
    const std::size_t first = corners.size();
    for (MeshWord word = words.next_in_line(); !word.empty() && word.text[0] != '#';
         word = words.next_in_line()) {
        // v, v/vt, v//vn or v/vt/vn
        const std::string_view index = word.text.substr(0, word.text.find('/'));
        const auto number = parse_index(index);
        if (!number || *number == 0) {
            source.complain(word.offset,
                            fmt::format("{} does not begin with the number of a vertex, which "
                                        "count from 1, or from -1 backwards",
                                        shown(word.text)));
            corners.resize(first);
            return;
        }
        const auto before = static_cast<std::int64_t>(vertex_count);
        corners.push_back({*number > 0 ? *number - 1 : before + *number, word.offset});
    }
    if (corners.size() - first < 3) {
        source.complain(place, fmt::format("a face has {} corners; expected 3 or more",
                                           corners.size() - first));
        corners.resize(first);
        return;
    }
    faces.push_back({first, corners.size() - first, place});
}

}  // namespace

MeshParts read_obj(MeshSource& source) {
    source.join_continued_lines();
    MeshParts parts;
    std::vector<Corner> corners;
    std::vector<Face> faces;
    WordReader words(source.bytes(), 0);
    do {
        const MeshWord keyword = words.next_in_line();
        if (keyword.empty() || keyword.text[0] == '#') continue;
        if (keyword.text == "v") {
            read_vertex(words, keyword.offset, source, parts.vertices);
        } else if (keyword.text == "f" || keyword.text == "fo") {
            read_face(words, keyword.offset, parts.vertices.size(), source, corners, faces);
        } else if (holds(free_form, keyword.text)) {
            source.complain(keyword.offset, fmt::format("{} belongs to a free-form surface; only "
                                                        "polygons (v, f) are read",
                                                        shown(keyword.text)));
        } else if (!holds(read_past, keyword.text)) {
            source.complain(keyword.offset, fmt::format("{} is not a statement of an OBJ file",
                                                        shown(keyword.text)));
        }
    } while (words.next_line());

    std::vector<std::uint32_t> polygon;
    for (const Face& face : faces) {
        polygon.clear();
        for (std::size_t i = face.first_corner; i < face.first_corner + face.corner_count; ++i) {
            const auto& [vertex, place] = corners[i];
            if (vertex < 0 || vertex >= static_cast<std::int64_t>(parts.vertices.size()))
                source.complain(place, fmt::format("there is no such vertex; the file has {}",
                                                   parts.vertices.size()));
            else
                polygon.push_back(static_cast<std::uint32_t>(vertex));
        }
        if (polygon.size() == face.corner_count) parts.add_polygon(polygon, face.place, source);
    }
    return parts;
}

}  // namespace lucerna::io
