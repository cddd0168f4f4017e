// The scene file: YAML in, the parts and settings of a simulation out. docs/scene-reference.md is
// its complete description.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "optics/scene.h"
#include "optics/transport/settings.h"

namespace lucerna::io {

/// What was read from a scene file and the files that it refers to.
struct SceneFile {
    optics::SceneParts parts;
    optics::Settings settings;
    std::vector<std::string> warnings;
    std::vector<std::filesystem::path> files;  ///< all files read, the scene first
};

/// Throws InputError with everything that is wrong with the file.
SceneFile read_scene_file(const std::filesystem::path& path);

/// What was read, for people: objects, triangles, lights with their flux, media, observers,
/// warnings.
std::string scene_summary(const SceneFile& scene);

}  // namespace lucerna::io
