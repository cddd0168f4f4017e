#include "io/scene_objects.h"

#include <fmt/ranges.h>

#include "io/scene_shapes.h"
#include "optics/geometry/mesh_check.h"

namespace lucerna::io {

using namespace optics;

std::string SceneObjects::why_not_solid(const Shape& shape) {
    const auto* instance = std::get_if<MeshInstance>(&shape);
    if (!instance) return is_solid(shape) ? "" : "it is a flat sheet, which holds no volume";
    const auto [found, is_new] = mesh_complaints_.try_emplace(instance->mesh.get());
    // Stricter than is_solid(): in a surface that cuts itself light would be lost.
    if (is_new)
        found->second =
            fmt::format("{}", fmt::join(check_mesh(*instance->mesh).complaints(), "; "));
    return found->second;
}

SceneObjects::SceneObjects(SceneContext& context, SceneMaterials& materials,
                           const YamlCursor& section) {
    for (const YamlCursor& entry : section.list()) read(context, materials, entry);
}

void SceneObjects::read(SceneContext& context, SceneMaterials& materials, const YamlCursor& entry) {
    YamlMap map(entry);
    const std::string name = names_.read(map);
    if (!name.empty()) ids_[name];
    const YamlCursor material_name = map.required("material", "the name of a material, or none");
    const Material* material = materials.find(material_name);
    const Placement placement = read_placement(map.optional("place"));
    const YamlCursor shape_cursor = map.required("shape", "a shape such as {type: sphere, ...}");
    const auto shape = read_shape(context, shape_cursor, placement);
    const YamlCursor up = map.optional("up");
    const YamlCursor priority = map.optional("priority");
    map.no_other_keys();
    if (!material || !shape || name.empty()) return;

    Object object{name,           *shape, material->front, material->back, material->medium,
                  material->name, {}};
    if (up)
        object.up = read_direction(up);
    else if (material->needs_up)
        entry.complain(
            fmt::format("the key 'up' is missing: the measured material '{}' depends on "
                        "the direction on the surface that was up when it was measured",
                        material->name));
    if (priority && !material->medium)
        priority.complain(fmt::format("only solids of a dielectric have a priority; '{}' is none",
                                      material->name));
    if (material->medium) {
        if (const std::string why = why_not_solid(*shape); !why.empty()) {
            const auto file = YamlMap(shape_cursor).optional("file").word();
            shape_cursor.complain(fmt::format("{}cannot be of the dielectric '{}': {}",
                                              file ? "'" + *file + "' " : "", material->name, why));
            return;
        }
        if (priority) {
            Medium medium = context.scene.parts.media[*material->medium];
            medium.priority = read_priority(priority);
            object.interior = context.scene.parts.add(std::move(medium));
        }
    }
    ids_[name] = context.scene.parts.add(std::move(object));
}

std::optional<ObjectId> SceneObjects::find(const YamlCursor& cursor) const {
    const auto name = cursor.word();
    if (!name) return {};
    const auto found = ids_.find(*name);
    if (found != ids_.end()) return found->second;
    std::vector<std::string> known;
    for (const auto& [key, id] : ids_) known.push_back(key);
    cursor.complain(fmt::format("there is no object '{}'{}", *name, did_you_mean(*name, known)));
    return {};
}

}  // namespace lucerna::io
