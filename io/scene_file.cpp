#include "io/scene_file.h"

#include <algorithm>

#include "io/scene_lights.h"
#include "io/scene_materials.h"
#include "io/scene_objects.h"
#include "io/scene_observers.h"
#include "io/scene_settings.h"

namespace lucerna::io {
namespace {

/// The version key comes first, so that a later format can be told before anything else is read.
void read_version(YamlMap& map) {
    const YamlCursor version = map.required(
        "lucerna", "the version of the scene format, \"lucerna: 1\", as the first key");
    if (!version) return;
    if (map.entries().front().key != "lucerna")
        version.complain("must be the first key of the file");
    if (version.word() != "1")
        version.complain("expected 1, the version of the scene format that this program reads");
}

/// Complaints in the order of the file. Those of other files stay behind the one that leads to
/// them.
void throw_sorted(const Diagnostics& diagnostics, const std::string& scene) {
    struct Placed {
        int line, column;
        Diagnostic diagnostic;
    };
    std::vector<Placed> placed;
    for (const Diagnostic& diagnostic : diagnostics.list()) {
        const bool elsewhere = diagnostic.where.file != scene && !placed.empty();
        placed.push_back({elsewhere ? placed.back().line : diagnostic.where.line,
                          elsewhere ? placed.back().column : diagnostic.where.column, diagnostic});
    }
    std::stable_sort(placed.begin(), placed.end(), [](const Placed& a, const Placed& b) {
        return std::pair(a.line, a.column) < std::pair(b.line, b.column);
    });
    Diagnostics sorted;
    for (Placed& entry : placed)
        sorted.add(std::move(entry.diagnostic.where), std::move(entry.diagnostic.message));
    sorted.throw_if_any();
}

/// What no reader of a single section can see.
void check_whole(const SceneFile& scene, const YamlCursor& root) {
    const optics::SceneParts& parts = scene.parts;
    if (parts.lights.empty()) root.complain("no light is described; expected the section 'lights'");
    if (parts.observers.empty() && parts.receivers.empty())
        root.complain("nothing is to be computed; expected 'cameras' or 'sensors'");
}

}  // namespace

SceneFile read_scene_file(const std::filesystem::path& path, const std::string& shifted) {
    SceneFile scene;
    Diagnostics diagnostics;
    const std::string file = path.string();
    const auto document = read_yaml_file(path, diagnostics);
    scene.files.push_back(path);
    SceneContext context{scene, diagnostics, path.parent_path(), {}, {}};

    UncertainInputs uncertain(shifted);
    const YamlCursor root(*document, file, diagnostics, &uncertain);
    YamlMap map(root);
    read_version(map);
    if (const YamlCursor up = map.optional("up")) context.up = read_direction(up);
    SceneMaterials materials(context, map.optional("materials"));
    const SceneObjects objects(context, materials, map.optional("objects"));
    read_lights(context, objects, map.optional("lights"));
    read_cameras(context, map.optional("cameras"));
    read_sensors(context, objects, map.optional("sensors"));
    scene.settings = read_settings(map.optional("simulation").exact(), scene.parts);
    map.no_other_keys();
    if (diagnostics.empty()) check_whole(scene, root);
    throw_sorted(diagnostics, file);
    scene.uncertain_inputs = uncertain.list();
    return scene;
}

}  // namespace lucerna::io
