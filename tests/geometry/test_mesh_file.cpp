#include <bit>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <numeric>

#include "core/diagnostics.h"
#include "core/random.h"
#include "io/mesh_file.h"
#include "optics/geometry/mesh_check.h"
#include "tests/support/scratch_folder.h"

namespace lucerna::io {

namespace {

using Catch::Contains;
using Catch::Matchers::WithinRel;

const std::filesystem::path data = LUCERNA_TEST_DATA "/geometry";

MeshFile read(const std::string& name, const std::string& bytes, double unit_m = 1.0) {
    const test::ScratchFolder folder;
    return read_mesh_file(folder.write(name, bytes), unit_m);
}

/// All complaints about the file, one per line, without the folder.
std::string complaints(const std::string& name, const std::string& bytes) {
    const test::ScratchFolder folder;
    try {
        read_mesh_file(folder.write(name, bytes), 1.0);
    } catch (const InputError& error) {
        std::string text;
        for (const Diagnostic& diagnostic : error.diagnostics()) {
            const std::string line = diagnostic.text();
            text += line.substr(line.find(name) + name.size()) + "\n";
        }
        return text;
    }
    return "";
}

double area_m2(const optics::Mesh& mesh) {
    return std::accumulate(mesh.areas_m2.begin(), mesh.areas_m2.end(), 0.0);
}

/// Volume as the sum of the signed tetrahedra to the origin, from vertices alone.
double volume_m3(const optics::Mesh& mesh) {
    double sum = 0.0;
    for (const auto& [a, b, c] : mesh.triangles)
        sum += mesh.vertices[a].dot(mesh.vertices[b].cross(mesh.vertices[c])) / 6.0;
    return sum;
}

std::string binary(std::uint64_t bits, std::size_t bytes, bool big_endian) {
    std::string text;
    for (std::size_t i = 0; i < bytes; ++i)
        text += static_cast<char>(bits >> (8 * (big_endian ? bytes - 1 - i : i)));
    return text;
}
std::string binary(float value, bool big_endian = false) {
    return binary(std::bit_cast<std::uint32_t>(value), 4, big_endian);
}
std::string binary(double value, bool big_endian) {
    return binary(std::bit_cast<std::uint64_t>(value), 8, big_endian);
}

// A tetrahedron with corners 0 and the unit vectors: volume 1/6, area 3/2 + sqrt(3)/2.
const double corner_positions[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
const std::uint32_t corner_faces[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};

std::string binary_stl() {
    std::string bytes(80, ' ');
    bytes.replace(0, 5, "solid");  // as some programs write it
    bytes += binary(std::uint64_t{4}, 4, false);
    for (const auto& face : corner_faces) {
        bytes += std::string(12, '\0');
        for (const std::uint32_t corner : face)
            for (const double x : corner_positions[corner]) bytes += binary(static_cast<float>(x));
        bytes += std::string(2, '\0');
    }
    return bytes;
}

std::string text_stl() {
    std::string text = "solid a corner\n";
    for (const auto& face : corner_faces) {
        text += "  facet normal 0 0 0\n    outer loop\n";
        for (const std::uint32_t corner : face) {
            text += "      vertex";
            for (const double x : corner_positions[corner]) text += fmt::format(" {:e}", x);
            text += "\n";
        }
        text += "    endloop\n  endfacet\n";
    }
    return text + "endsolid a corner\n";
}

std::string ply_header(const std::string& format) {
    return "ply\nformat " + format +
           " 1.0\ncomment made by hand\nelement vertex 4\nproperty double x\nproperty double y\n"
           "property double z\nproperty uchar red\nelement face 4\n"
           "property list uchar int vertex_indices\nelement edge 1\nproperty short weight\n"
           "end_header\n";
}

std::string text_ply() {
    std::string text = ply_header("ascii");
    for (const auto& p : corner_positions) text += fmt::format("{} {} {} 255\n", p[0], p[1], p[2]);
    for (const auto& f : corner_faces) text += fmt::format("3 {} {} {}\n", f[0], f[1], f[2]);
    return text + "7\n";
}

std::string binary_ply(bool big_endian) {
    std::string bytes = ply_header(big_endian ? "binary_big_endian" : "binary_little_endian");
    for (const auto& p : corner_positions) {
        for (const double x : p) bytes += binary(x, big_endian);
        bytes += '\xff';
    }
    for (const auto& face : corner_faces) {
        bytes += '\3';
        for (const std::uint32_t corner : face)
            bytes += binary(std::uint64_t{corner}, 4, big_endian);
    }
    return bytes + binary(std::uint64_t{7}, 2, big_endian);
}

const std::string corner_obj =
    "# comment\r\nmtllib x.mtl\no corner\nv 0 0 0\nv 1 0 0 1\nv +0 1.0e0 0\nv 0 0 1 0.5 0.5 0.5\n"
    "vt 0 0\nvn 0 0 1\ng a b\nusemtl wood\ns off\nf 1/1 3/1 2/1\nf -4//1 \\\n -3//1 -1//1\n"
    "f 1/1/1 4/1/1 3/1/1 # end\nf 2 3 4\n";

}  // namespace

TEST_CASE("All forms of the formats give the same tetrahedron", "[golden]") {
    const auto [name, bytes] = GENERATE(table<std::string, std::string>(
        {{"a.obj", corner_obj},
         {"a.OBJ", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4"},
         {"a.stl", text_stl()},
         {"b.stl", binary_stl()},
         {"a.ply", text_ply()},
         {"b.ply", binary_ply(false)},
         {"c.ply", binary_ply(true)}}));
    CAPTURE(name);
    const MeshFile file = read(name, bytes, 1e-3);
    CHECK(file.warnings.empty());
    CHECK(file.mesh->vertices.size() == 4);
    CHECK(file.mesh->triangles.size() == 4);
    CHECK(file.mesh->closed);
    CHECK_THAT(area_m2(*file.mesh), WithinRel((1.5 + std::sqrt(3.0) / 2.0) * 1e-6, 1e-12));
    CHECK_THAT(volume_m3(*file.mesh), WithinRel(1e-9 / 6.0, 1e-12));
}

TEST_CASE("Concave polygons are cut along their inside", "[unit]") {
    // A U of width 3 and height 2 with a notch of 1 x 1: area 5. A fan would cover the notch.
    const MeshFile file = read("u.obj",
                               "v 0 0 0\nv 3 0 0\nv 3 2 0\nv 2 2 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\n"
                               "v 0 2 0\nf 1 2 3 4 5 6 7 8\n");
    CHECK_THAT(area_m2(*file.mesh), WithinRel(5.0, 1e-12));
    CHECK(file.mesh->patch_areas_m2.size() == 1);
    for (const Vec3& normal : file.mesh->normals) CHECK(normal == Vec3(0, 0, 1));
}

TEST_CASE("Real mesh files", "[golden]") {
    SECTION("measured Cornell box, millimetres") {
        const MeshFile block = read_mesh_file(data / "largebox.obj", 1e-3);
        CHECK(block.mesh->triangles.size() == 12);
        // Footprint of the block's published corners by the shoelace formula, height 330 mm.
        const double corners[4][2] = {{423, 247}, {265, 296}, {314, 456}, {472, 406}};
        double footprint = 0.0;
        for (int i = 0; i < 4; ++i) {
            const auto& p = corners[i];
            const auto& q = corners[(i + 1) % 4];
            footprint += 0.5 * (p[0] * q[1] - p[1] * q[0]);
        }
        CHECK_THAT(std::abs(volume_m3(*block.mesh)),
                   WithinRel(std::abs(footprint) * 330.0 * 1e-9, 1e-6));
        CHECK(block.mesh->patch_areas_m2.size() == 6);
    }
    SECTION("a box and the same turned inside out") {
        const auto outward = read_mesh_file(data / "box_normals_outwards.obj", 1.0).mesh;
        const auto inward = read_mesh_file(data / "box_normals_inwards.obj", 1.0).mesh;
        CHECK(outward->closed);
        CHECK_FALSE(inward->closed);
        CHECK(optics::check_mesh(*outward).solid());
        const optics::MeshReport report = optics::check_mesh(*inward);
        CHECK(report.closed);
        CHECK_FALSE(report.oriented_outward);
        REQUIRE(report.complaints().size() == 1);
        CHECK_THAT(report.complaints()[0], Contains("inward"));
    }
    SECTION("diamond") {
        const auto diamond = read_mesh_file(data / "diamond.obj", 1e-3).mesh;
        CHECK(diamond->triangles.size() == 110);
        CHECK(optics::check_mesh(*diamond).closed);
    }
    SECTION("Cornell box of many objects, polygons with normals") {
        const auto box = read_mesh_file(data / "cornell_box.obj", 1.0).mesh;
        CHECK(box->triangles.size() == 32);
    }
}

TEST_CASE("Errors of an OBJ file name line and column, all at once", "[unit]") {
    const std::string text = complaints("a.obj",
                                        "v 0 0 0\nv 1 zero 0\nv 0 1\nv 0 0 nan\nv 0 0 1e999\n"
                                        "f 1 2 9\nf 1 2 -7\nf 0 1 2\nf 1 2\nf 1/x y 2\nquux 3\n"
                                        "curv 0 1\n");
    CHECK_THAT(text, Contains(":2:5: \"zero\" is not a finite number"));
    CHECK_THAT(text, Contains(":3:1: a vertex has 2 of 3 coordinates"));
    CHECK_THAT(text, Contains(":4:7: \"nan\" is not a finite"));
    CHECK_THAT(text, Contains(":5:7: \"1e999\" is not a finite"));
    CHECK_THAT(text, Contains(":6:7: there is no such vertex; the file has 5"));
    CHECK_THAT(text, Contains(":7:7: there is no such vertex"));
    CHECK_THAT(text, Contains(":8:3: \"0\""));
    CHECK_THAT(text, Contains(":9:1: a face has 2 corners"));
    CHECK_THAT(text, Contains(":10:7: \"y\""));
    CHECK_THAT(text, Contains(":11:1: \"quux\" is not a statement"));
    CHECK_THAT(text, Contains(":12:1: \"curv\" belongs to a free-form surface"));
    // A line that goes on still counts.
    CHECK_THAT(complaints("b.obj", "v 0 0 \\\n 0\nv 1 x 0\n"), Contains(":3:5: \"x\""));
    CHECK_THAT(complaints("c.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n"), Contains("no triangle"));
    CHECK_THAT(complaints("c.obj", "v 0 0 0\nv 1e12 0 0\nv 0 1 0\nf 1 2 3\n"),
               Contains("expected less than"));
    CHECK_THAT(complaints("d.obj", ""), Contains("is empty"));
    CHECK_THAT(complaints("e.obj", "v 0 0 0\nv 1 1 0\nv 1 0 0\nv 0 1 0\nf 1 2 3 4\n"),
               Contains(":5:1: this face of 4 corners crosses itself"));
    CHECK_THAT(complaints("a.step", "x"), Contains("expected .obj, .ply or .stl"));
}

TEST_CASE("Errors of an STL file name the place", "[unit]") {
    std::string text = text_stl();
    const std::size_t vertex = text.find("vertex");
    CHECK_THAT(complaints("a.stl", std::string(text).replace(vertex, 6, "vertx ")),
               Contains(":4:7: found \"vertx\"; expected vertex"));
    CHECK_THAT(complaints("a.stl", text.substr(0, vertex + 7)), Contains("the file ends here"));
    CHECK_THAT(complaints("a.stl", std::string(text).replace(vertex + 7, 3, "inf")),
               Contains(":4:14: found \"inf"));
    const std::string bytes = binary_stl();
    CHECK_THAT(complaints("b.stl", "X" + bytes.substr(1, 200)),
               Contains("byte 80: 4 triangles are stated, but the file ends after 2"));
    CHECK_THAT(complaints("b.stl", std::string(bytes).replace(96, 4, binary(INFINITY))),
               Contains("byte 96: is not a finite coordinate"));
    CHECK_THAT(complaints("b.stl", "junk"), Contains("byte 0").operator||(Contains("neither")));
    const MeshFile longer = read("b.stl", "X" + bytes.substr(1) + "tail");
    REQUIRE(longer.warnings.size() == 1);
    CHECK_THAT(longer.warnings[0], Contains("byte 284"));
}

TEST_CASE("Errors of a PLY file name the place", "[unit]") {
    const auto replaced = [](std::string text, const std::string& from, const std::string& to) {
        return text.replace(text.find(from), from.size(), to);
    };
    const std::string text = text_ply();
    CHECK_THAT(complaints("a.ply", replaced(text, "ply", "plx")), Contains(":1:1: found \"plx\""));
    CHECK_THAT(complaints("a.ply", replaced(text, "ascii", "utf8")),
               Contains(":2:8: found \"utf8\"; expected ascii, binary_little_endian"));
    CHECK_THAT(complaints("a.ply", replaced(text, "property double y", "property triple y")),
               Contains(":6:10: found \"triple\"; expected a type"));
    CHECK_THAT(complaints("a.ply", replaced(text, "double z", "double w")),
               Contains("the vertices have no property z"));
    CHECK_THAT(complaints("a.ply", replaced(text, "element face 4", "element face 9000000000")),
               Contains(":9:14: 9000000000 entries of \"face\" do not fit"));
    CHECK_THAT(complaints("a.ply", replaced(text, "0 1 0 255", "0 one 0 255")),
               Contains(":16:3: found \"one\"; expected y of vertex 3"));
    CHECK_THAT(complaints("a.ply", replaced(text, "3 1 2 3", "3 1 2 4")),
               Contains(":21:1: this face refers to vertex 4; the file has 4, counted from 0"));
    CHECK_THAT(complaints("a.ply", replaced(text, "3 1 2 3", "2 1 2")),
               Contains(":21:1: a face has 2 corners"));
    CHECK_THAT(complaints("a.ply", replaced(text, "end_header", "end")), Contains("end_header"));
    CHECK_THAT(complaints("a.ply", text.substr(0, text.size() - 2)),
               Contains("the file ends within edge 1 of 1"));
    CHECK_THAT(complaints("a.ply", replaced(text, "element face 4", "element fase 4")),
               Contains("has no element \"face\""));

    const std::string bytes = binary_ply(true);
    CHECK_THAT(complaints("b.ply", bytes.substr(0, bytes.size() - 8)),
               Contains("byte ").operator&&(Contains("within face 4 of 4")));
    std::string wrong = bytes;
    wrong[bytes.size() - 3] = 9;  // the last index of the last face
    CHECK_THAT(complaints("b.ply", wrong),
               Contains("byte ").operator&&(Contains("refers to vertex 9")));
}

TEST_CASE("Triangles without area are left out with a warning", "[unit]") {
    const MeshFile file =
        read("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 2 0 0\nf 1 2 3\nf 1 2 2\nf 1 2 4\n");
    CHECK(file.mesh->triangles.size() == 1);
    REQUIRE(file.warnings.size() == 1);
    CHECK_THAT(file.warnings[0], Contains(":6:1: 2 triangles without area left out"));
}

TEST_CASE("No damage to a mesh file makes the readers fail otherwise than by complaint", "[fuzz]") {
    const std::vector<std::pair<std::string, std::string>> files{
        {"f.obj", corner_obj}, {"f.stl", text_stl()},        {"g.stl", binary_stl()},
        {"f.ply", text_ply()}, {"g.ply", binary_ply(false)}, {"h.ply", binary_ply(true)}};
    RandomStream random(7, 0, RandomPurpose::test, 0);
    int accepted = 0;
    int rejected = 0;
    for (int i = 0; i < 6000; ++i) {
        auto [name, bytes] = files[static_cast<std::size_t>(i) % files.size()];
        const auto below = [&](std::size_t n) {
            return static_cast<std::size_t>(random.uniform() * static_cast<double>(n));
        };
        const std::size_t edits = 1 + below(3);
        for (std::size_t k = 0; k < edits; ++k) {
            const std::size_t at = below(bytes.size());
            switch (below(4)) {
                case 0:
                    bytes[at] = static_cast<char>(below(256));
                    break;
                case 1:
                    bytes.resize(at + 1);
                    break;
                case 2:
                    bytes.erase(at, 1 + below(4));
                    break;
                default:
                    bytes.insert(at, bytes.substr(below(bytes.size()), 1 + below(6)));
            }
            if (bytes.empty()) bytes.push_back('x');
        }
        try {
            const MeshFile file = read(name, bytes);
            for (const Vec3& normal : file.mesh->normals)
                REQUIRE(std::abs(normal.norm() - 1.0) < 1e-9);
            ++accepted;
        } catch (const InputError&) {
            ++rejected;
        }
    }
    CHECK(accepted > 100);
    CHECK(rejected > 3000);
}

}  // namespace lucerna::io
