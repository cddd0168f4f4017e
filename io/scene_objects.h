// The objects of a scene.
#pragma once

#include "io/scene_materials.h"

namespace lucerna::io {

/// Objects by name, for the lights and receivers that stand on them.
class SceneObjects {
public:
    /// Reads the section `objects`.
    SceneObjects(SceneContext& context, SceneMaterials& materials, const YamlCursor& section);

    /// The object that a scalar names; nothing after a complaint, or if the object is itself wrong.
    std::optional<optics::ObjectId> find(const YamlCursor& name) const;

private:
    void read(SceneContext& context, SceneMaterials& materials, const YamlCursor& entry);
    /// Why the shape cannot hold a transparent medium, or "" if it can.
    std::string why_not_solid(const optics::Shape& shape);

    UniqueNames names_;
    std::map<std::string, std::optional<optics::ObjectId>> ids_;
    std::map<const optics::Mesh*, std::string> mesh_complaints_;  ///< "": fit to hold a medium
};

}  // namespace lucerna::io
