// The section `simulation`.
#pragma once

#include "io/yaml_cursor.h"
#include "optics/transport/settings.h"

namespace lucerna::io {

/// Reads the section; what it leaves out keeps its default.
optics::Settings read_settings(const YamlCursor& section);

}  // namespace lucerna::io
