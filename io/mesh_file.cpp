#include "io/mesh_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "io/mesh_source.h"

namespace lucerna::io {

namespace {

MeshParts read_parts(MeshSource& source) {
    std::string ending = source.path().extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (ending == ".obj") return read_obj(source);
    if (ending == ".ply") return read_ply(source);
    if (ending == ".stl") return read_stl(source);
    throw InputError({source.path().string()},
                     "is not known as a mesh by its ending; expected .obj, .ply or .stl");
}

double triangle_area_m2(const MeshParts& parts, const std::array<std::uint32_t, 3>& triangle) {
    const Vec3& a = parts.vertices[triangle[0]];
    return 0.5 * (parts.vertices[triangle[1]] - a).cross(parts.vertices[triangle[2]] - a).norm();
}

constexpr double largest_coordinate_m = 1e9;

/// Metres from here on; a coordinate beyond any building is a sign of damage or of a wrong unit.
void scale(MeshParts& parts, double unit_m, const MeshSource& source) {
    for (Vec3& vertex : parts.vertices) {
        vertex *= unit_m;
        if (vertex.cwiseAbs().maxCoeff() > largest_coordinate_m)
            throw InputError({source.path().string()},
                             fmt::format("has a vertex {} m from the origin; expected less than "
                                         "{} m",
                                         vertex.norm(), largest_coordinate_m));
    }
}

/// Leaves out triangles without area, which have no normal.
void drop_degenerate(MeshParts& parts, const MeshSource& source) {
    std::size_t kept = 0;
    std::size_t first_dropped_place = 0;
    for (std::size_t i = 0; i < parts.triangles.size(); ++i) {
        if (triangle_area_m2(parts, parts.triangles[i]) > optics::smallest_triangle_m2)
            parts.triangles[kept++] = parts.triangles[i];
        else if (kept == i)
            first_dropped_place = parts.places[i];
    }
    const std::size_t dropped = parts.triangles.size() - kept;
    parts.triangles.resize(kept);
    if (dropped > 0)
        parts.warnings.push_back(source.text_at(
            first_dropped_place,
            fmt::format("{} without area left out, the first of them here",
                        dropped == 1 ? "a triangle" : fmt::format("{} triangles", dropped))));
}

}  // namespace

MeshFile read_mesh_file(const std::filesystem::path& path, double unit_m) {
    MeshSource source(path);
    MeshParts parts = read_parts(source);
    source.throw_if_any();
    scale(parts, unit_m, source);
    drop_degenerate(parts, source);
    if (parts.triangles.empty()) throw InputError({path.string()}, "has no triangle with an area");
    return {optics::prepare_mesh(std::move(parts.vertices), std::move(parts.triangles)),
            std::move(parts.warnings)};
}

}  // namespace lucerna::io
