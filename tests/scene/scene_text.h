// Scenes from text, and the complaints that they cause.
#pragma once

#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "core/diagnostics.h"
#include "io/scene_file.h"
#include "tests/support/scratch_folder.h"

namespace lucerna::io {

using test::ScratchFolder;

/// The text with the only occurrence of `from` replaced.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
    const auto at = text.find(from);
    REQUIRE(at != std::string::npos);
    REQUIRE(text.find(from, at + 1) == std::string::npos);
    return text.replace(at, from.size(), to);
}

/// A small scene in which nothing is wrong, with one entry of most kinds.
inline const std::string good_scene = R"(lucerna: 1
up: z
materials:
  white: {type: diffuse, reflectance: 0.5}
  sheet: {type: diffuse, reflectance: 0.3, transmittance: 0.6}
  steel: {type: conductor, n: 2.5, k: 3.4, roughness: 0.3}
  glass: {type: dielectric, index: 1.5, absorption: 0.3 1/m, priority: 2}
  varnish: {type: mixture, components: [{weight: 0.9, material: white}, {weight: 0.1, material: steel}]}
  lined: {type: two_sided, front: white, back: steel}
objects:
  - name: floor
    material: white
    shape: {type: rectangle, corner: [0 m, 0 m, 0 m], edge_u: [2 m, 0 m, 0 m], edge_v: [0 m, 1 m, 0 m]}
  - name: plate
    material: lined
    shape: {type: disk, center: [0 m, 0 m, 1 m], normal: -z, radius: 10 cm, inner_radius: 2 cm}
  - name: ball
    material: glass
    shape: {type: sphere, center: [1 m, 0.5 m, 0.5 m], radius: 100 mm}
  - name: gate
    material: none
    shape: {type: rectangle, center: [1 m, 0.5 m, 0.9 m], size: [1 m, 0.5 m], normal: z, up: y}
lights:
  - {name: lamp, type: area, on: plate, side: front, luminance: 1000 cd/m2, spectrum: A}
  - {name: bulb, type: point, position: [1 m, 0.5 m, 2 m], flux: 100 lm, spectrum: D65}
cameras:
  - {name: view, type: perspective, from: [1 m, -3 m, 1 m], to: [1 m, 0 m, 0.5 m], fov: 40 deg, resolution: [64, 48]}
sensors:
  - {name: spot, type: illuminance, position: [1 m, 0.5 m, 0.01 m], normal: z}
  - {name: meter, type: luminance_meter, position: [1 m, -1 m, 1 m], target: [1 m, 0.5 m, 0 m], acceptance: 2 deg}
  - {name: through, type: flux, on: gate}
simulation: {method: combined, accuracy: {image: 2 %, sensors: 1%}, time_limit: 10 min, seed: 7}
)";

inline SceneFile read_scene_text(const std::string& text) {
    const ScratchFolder folder;
    return read_scene_file(folder.write("scene.yaml", text));
}

/// What is wrong with a scene; empty if nothing is.
inline std::vector<Diagnostic> complaints_about(const std::filesystem::path& scene) {
    try {
        read_scene_file(scene);
        return {};
    } catch (const InputError& error) {
        return error.diagnostics();
    }
}

/// Checks that a scene is refused with one complaint, which contains `message` and stands where the
/// text has an '@' (which is taken out).
inline void check_refused_at_mark(std::string text, const std::string& message) {
    const auto mark = text.find('@');
    REQUIRE(mark != std::string::npos);
    text.erase(mark, 1);
    const auto line_start = text.rfind('\n', mark == 0 ? 0 : mark - 1);
    const ScratchFolder folder;
    const auto list = complaints_about(folder.write("scene.yaml", text));
    INFO(text);
    REQUIRE_FALSE(list.empty());
    CAPTURE(list.front().text());
    CHECK(list.size() == 1);
    CHECK(list.front().where.line ==
          1 + std::count(text.begin(), text.begin() + static_cast<long>(mark), '\n'));
    CHECK(list.front().where.column ==
          static_cast<int>(line_start == std::string::npos ? mark + 1 : mark - line_start));
    CHECK_THAT(list.front().message, Catch::Contains(message));
}

}  // namespace lucerna::io
