// Triangle meshes from files: Wavefront OBJ, PLY and STL.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "optics/geometry/mesh.h"

namespace lucerna::io {

struct MeshFile {
    std::shared_ptr<const optics::Mesh> mesh;
    std::vector<std::string> warnings;  ///< what was left out, with its place in the file
};

/// Reads a mesh; the format follows from its ending, .obj, .ply or .stl.
///
/// Polygons are cut into triangles; groups, materials, texture coordinates and shading normals are
/// read past. Triangles without area are left out with a warning. The corners of an STL file that
/// are at exactly the same position become one vertex.
///
/// @param unit_m  length of the file's unit of coordinates [m]; 0.001 for a file in millimetres
/// Throws InputError with the line (text) or the byte (binary) of each thing that is wrong.
MeshFile read_mesh_file(const std::filesystem::path& path, double unit_m);

}  // namespace lucerna::io
