// The materials of a scene.
#pragma once

#include "io/scene_context.h"
#include "optics/material/medium.h"

namespace lucerna::io {

/// What an object gets from its material.
struct Material {
    std::string name;
    optics::BsdfId front, back;
    std::optional<optics::MediumId> medium;  ///< of a dielectric
    bool needs_up = false;                   ///< measured: depends on the direction of `up`
};

/// Materials by name. They may refer to each other in any order, but not in a circle.
class SceneMaterials {
public:
    /// Reads the section `materials`.
    SceneMaterials(SceneContext& context, const YamlCursor& section);

    /// The material that a scalar names, `none` included; nullptr after a complaint, or if the
    /// material is itself wrong.
    const Material* find(const YamlCursor& name);

private:
    struct Entry {
        YamlCursor cursor;
        enum class State { unread, reading, read } state = State::unread;
        std::optional<Material> material;  ///< nothing: it is wrong
    };

    void read(const std::string& name, Entry& entry);
    std::optional<Material> read_material(const std::string& name, const YamlCursor& cursor);
    std::optional<optics::Bsdf> read_opaque(const std::string& type, YamlMap& map, bool& needs_up);
    std::optional<optics::Bsdf> read_diffuse(YamlMap& map);
    std::optional<optics::Bsdf> read_conductor(YamlMap& map);
    std::optional<optics::Bsdf> read_mixture(YamlMap& map, bool& needs_up);
    std::optional<Material> read_dielectric(const std::string& name, YamlMap& map);
    std::optional<Material> read_two_sided(const std::string& name, YamlMap& map);
    std::optional<optics::SpectrumId> add(std::optional<spectral::Spectrum> spectrum);

    SceneContext& context_;
    Material none_{"none", optics::pass_through, optics::pass_through, {}, false};
    std::map<std::string, Entry> entries_;
};

/// The priority of a medium where solids overlap: a whole number, the higher one counts.
int read_priority(const YamlCursor& cursor);

}  // namespace lucerna::io
