// The section `simulation`.
#pragma once

#include "io/yaml_cursor.h"
#include "optics/scene.h"
#include "optics/transport/settings.h"

namespace lucerna::io {

/// Reads the section; what it leaves out keeps its default.
/// @param parts  of the scene, whose sensors the section may name.
optics::Settings read_settings(const YamlCursor& section, const optics::SceneParts& parts);

}  // namespace lucerna::io
