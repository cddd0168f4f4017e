// Broken files that a scene refers to: the complaint stands at their place in the scene and says
// why.
#include "scene_text.h"

using namespace lucerna;
using namespace lucerna::io;

namespace {

struct Broken {
    std::string name, content;
};

std::string cube_obj(bool inside_out, bool open) {
    std::string text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n";
    const std::vector<std::string> out{"4 3 2 1", "5 6 7 8", "1 2 6 5", "2 3 7 6", "3 4 8 7"};
    const std::vector<std::string> in{"1 2 3 4", "8 7 6 5", "5 6 2 1", "6 7 3 2", "7 8 4 3"};
    for (const std::string& face : inside_out ? in : out) text += "f " + face + "\n";
    if (!open) text += inside_out ? "f 8 5 1 4\n" : "f 4 1 5 8\n";
    return text;
}

/// Complaints about the good scene with one place changed and these files beside it.
std::vector<Diagnostic> complaints_with(const std::vector<Broken>& files, const std::string& from,
                                        const std::string& to) {
    const ScratchFolder folder;
    for (const Broken& file : files) folder.write(file.name, file.content);
    const auto scene = folder.write("scene.yaml", replaced(good_scene, from, to));
    auto list = complaints_about(scene);
    for (Diagnostic& diagnostic : list)
        diagnostic.where.file = std::filesystem::path(diagnostic.where.file).filename();
    return list;
}

const std::string ball = "{type: sphere, center: [1 m, 0.5 m, 0.5 m], radius: 100 mm}";
const std::string bulb = "type: point, position: [1 m, 0.5 m, 2 m], flux: 100 lm, spectrum: D65";

std::string luminaire(const std::string& file) {
    return "type: luminaire, file: " + file +
           ", position: [1 m, 0.5 m, 2 m], aim: down, c0: x, spectrum: D65";
}

}  // namespace

TEST_CASE("A missing file is refused where the scene names it", "[unit]") {
    const auto list = complaints_with({}, ball, "{type: mesh, file: nowhere.obj, unit: mm}");
    REQUIRE(list.size() == 1);
    CHECK(list[0].where.line == 19);
    CHECK(list[0].where.column == 31);
    CHECK_THAT(list[0].message,
               Catch::Contains("there is no file") && Catch::Contains("nowhere.obj"));
}

TEST_CASE("A dielectric needs a closed mesh that is oriented outward", "[unit]") {
    const std::string mesh = "{type: mesh, file: cube.obj, unit: cm}";
    CHECK(complaints_with({{"cube.obj", cube_obj(false, false)}}, ball, mesh).empty());

    for (const bool open : {true, false}) {
        const auto list = complaints_with({{"cube.obj", cube_obj(!open, open)}}, ball, mesh);
        REQUIRE(list.size() == 1);
        CHECK(list[0].where.file == "scene.yaml");
        CHECK(list[0].where.line == 19);
        CHECK(list[0].where.column == 12);
        CHECK_THAT(list[0].message, Catch::Contains("cannot be of the dielectric 'glass'") &&
                                        Catch::Contains("cube.obj") &&
                                        Catch::Contains(open ? "4" : "inward"));
        // The same mesh is a good opaque surface.
        const std::string opaque = replaced(good_scene, "material: glass", "material: white");
        const ScratchFolder folder;
        folder.write("cube.obj", cube_obj(!open, open));
        CHECK(complaints_about(folder.write("scene.yaml", replaced(opaque, ball, mesh))).empty());
    }
}

TEST_CASE("Broken files of any kind are refused with the file's own place", "[unit]") {
    struct Case {
        Broken file;
        std::string from, to;
    };
    const std::string stl = "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0\n";
    const std::string ply =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty "
        "float "
        "z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n";
    const std::string ies =
        "IESNA:LM-63-2002\n[TEST] x\nTILT=NONE\n1 1000 1 3 1 1 2 0 0 0\n1 1 10\n0 45 90\n0\n100 "
        "50\n";
    const std::string index =
        "DATA:\n  - type: formula 2\n    wavelength_range: 0.4 0.8\n"
        "    coefficients: 0 1.03 zero\n";
    const auto mesh = [](const std::string& name) {
        return "{type: mesh, file: " + name + ", unit: mm}";
    };
    const std::vector<Case> cases{
        {{"a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 7\n"}, ball, mesh("a.obj")},
        {{"b.obj", "v 0 0\nf 1 1 1\n"}, ball, mesh("b.obj")},
        {{"c.obj", "v 0 0 nan\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"}, ball, mesh("c.obj")},
        {{"empty.obj", ""}, ball, mesh("empty.obj")},
        {{"d.stl", stl}, ball, mesh("d.stl")},
        {{"e.stl", std::string(80, 'x') + std::string("\x10\0\0\0abc", 7)}, ball, mesh("e.stl")},
        {{"f.ply", ply}, ball, mesh("f.ply")},
        {{"g.ies", ies}, bulb, luminaire("g.ies")},
        {{"h.ies", "TILT=NONE\n1 1000 1 3 1 1 2 x y z\n"}, bulb, luminaire("h.ies")},
        {{"i.ldt", "company\n2\n1\n24\n15\n37\n5\n"}, bulb, luminaire("i.ldt")},
        {{"j.ldt", std::string(3000, '\xff')}, bulb, luminaire("j.ldt")},
        {{"k.yml", index}, "index: 1.5", "index: {file: k.yml}"},
        {{"l.yml", "DATA: ["}, "index: 1.5", "index: {file: l.yml}"},
        {{"m.csv", "wavelength_nm,white\n400,0.5\n390,0.6\n"},
         "reflectance: 0.5}",
         "reflectance: {file: m.csv, column: white}}"},
        {{"n.csv", "wavelength_nm,white\n400,0.5\n500,0.6\n"},
         "reflectance: 0.5}",
         "reflectance: {file: n.csv, column: red}}"},
        {{"o.xml", "<WindowElement><Optical>"},
         "{type: mixture, components: [{weight: 0.9, material: white}, {weight: 0.1, material: "
         "steel}]}",
         "{type: measured, file: o.xml}"},
    };
    for (const Case& each : cases) {
        CAPTURE(each.file.name);
        const auto list = complaints_with({each.file}, each.from, each.to);
        REQUIRE(list.size() >= 2);
        CHECK(list[0].where.file == "scene.yaml");
        CHECK(list[0].where.line > 0);
        CHECK(list[0].where.column > 0);
        CHECK(list[1].where.file == each.file.name);
        CHECK_FALSE(list[1].message.empty());
    }
}

TEST_CASE("A spectrum of a file that is out of range is refused", "[unit]") {
    const auto list =
        complaints_with({{"p.csv", "wavelength_nm,white\n400,0.5\n500,1.6\n"}}, "reflectance: 0.5}",
                        "reflectance: {file: p.csv, column: white}}");
    REQUIRE(list.size() == 1);
    CHECK(list[0].where.line == 4);
    CHECK_THAT(list[0].message, Catch::Contains("holds the value 1.6, which is more than 1"));
}
