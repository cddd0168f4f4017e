// data/ocio/config.ocio, embedded by io/CMakeLists.txt.
#pragma once

namespace lucerna::io {
extern const char* const ocio_config;
}  // namespace lucerna::io
