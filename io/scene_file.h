// The scene file: YAML in, the parts and settings of a simulation out. docs/scene-reference.md is
// its complete description.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "io/uncertain_inputs.h"
#include "optics/scene.h"
#include "optics/transport/settings.h"

namespace lucerna::io {

/// What was read from a scene file and the files that it refers to.
struct SceneFile {
    optics::SceneParts parts;
    optics::Settings settings;
    std::vector<UncertainInput> uncertain_inputs;
    std::vector<std::string> warnings;
    std::vector<std::filesystem::path> files;  ///< all files read, the scene first
};

/// Throws InputError with everything that is wrong with the file.
/// @param shifted  path of an uncertain input whose value is shifted by its uncertainty.
SceneFile read_scene_file(const std::filesystem::path& path, const std::string& shifted = "");

/// What was read, for people: objects, triangles, lights with their flux, media, observers,
/// warnings.
std::string scene_summary(const SceneFile& scene);

}  // namespace lucerna::io
