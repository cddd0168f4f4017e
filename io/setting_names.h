// How users write the choices among methods and schedulers, in scenes, on the command line and in
// reports.
#pragma once

#include <map>
#include <string>

#include "optics/transport/settings.h"

namespace lucerna::io {

/// "combined", "two-level", ...
const std::map<std::string, optics::Method>& methods();
const std::map<std::string, optics::Scheduler>& schedulers();

const std::string& name_of(optics::Method method);
const std::string& name_of(optics::Scheduler scheduler);

}  // namespace lucerna::io
