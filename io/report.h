// report.json: the numbers of a run for programs.
#pragma once

#include <string>

#include "optics/transport/result.h"

namespace lucerna::io {

/// What a report says about its run beside the result.
struct ReportSource {
    std::string scene;       ///< path of the scene as the user gave it
    std::string scene_hash;  ///< see content_hash()
};

/// The coverage probability of each expanded uncertainty that is reported.
inline constexpr double report_coverage = 0.95;

/// The report as JSON text; docs/results.md lists its keys. A number that is infinite or undefined,
/// such as the standard error of a single phase, is null, and a warning names it.
std::string report_json(const optics::Result& result, const ReportSource& source);

}  // namespace lucerna::io
