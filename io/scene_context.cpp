#include "io/scene_context.h"

#include <algorithm>

namespace lucerna::io {

void SceneContext::warn(const YamlCursor& at, const std::string& message) {
    const Diagnostic warning{at.where(), at.path().empty() ? message : at.path() + ": " + message};
    scene.warnings.push_back(warning.text());
}

std::optional<std::filesystem::path> SceneContext::file(const YamlCursor& name) {
    const auto word = name.word();
    if (!word) return {};
    const std::filesystem::path path = folder / *word;
    std::error_code failure;
    if (!std::filesystem::is_regular_file(path, failure)) {
        name.complain(fmt::format("there is no file '{}'", path.string()));
        return {};
    }
    if (std::find(scene.files.begin(), scene.files.end(), path) == scene.files.end())
        scene.files.push_back(path);
    return path;
}

std::string UniqueNames::read(YamlMap& map) {
    const YamlCursor cursor = map.required("name", "a name of your choice");
    const auto name = cursor.word();
    if (!name) return "";
    const auto [earlier, is_new] = lines_.emplace(*name, cursor.where().line);
    if (is_new) return *name;
    cursor.complain(fmt::format("the name '{}' is taken by line {}", *name, earlier->second));
    return "";
}

}  // namespace lucerna::io
