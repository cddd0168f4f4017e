// What the readers of the sections of a scene file share.
#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/diagnostics.h"
#include "io/scene_file.h"
#include "io/yaml_cursor.h"

namespace lucerna::io {

struct SceneContext {
    SceneFile& scene;
    Diagnostics& diagnostics;
    std::filesystem::path folder;  ///< relative paths of the scene start here
    std::optional<Vec3> up;        ///< key `up` of the scene
    std::map<std::string, std::shared_ptr<const optics::Mesh>> meshes;  ///< by file and unit

    void warn(const YamlCursor& at, const std::string& message);

    /// The file that a scalar names, noted as read; nothing after a complaint that there is none.
    std::optional<std::filesystem::path> file(const YamlCursor& name);

    /// The value of read(), or nothing and a complaint at `at` if it throws InputError or
    /// std::invalid_argument; the complaints of another file follow with their own places.
    template <typename Read>
    auto attempt(const YamlCursor& at, Read&& read) -> std::optional<decltype(read())> {
        try {
            return read();
        } catch (const InputError& error) {
            at.complain("this file cannot be used, as the next lines tell");
            diagnostics.add(error);
        } catch (const std::invalid_argument& error) {
            at.complain(error.what());
        }
        return {};
    }
};

/// Reads `name` and complains if an earlier entry of the list has it.
class UniqueNames {
public:
    /// The name, or "" after a complaint.
    std::string read(YamlMap& map);

private:
    std::map<std::string, int> lines_;
};

}  // namespace lucerna::io
