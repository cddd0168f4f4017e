// What pilot phases decide: radii and rays of the maps, and how images collect indirect light.
#pragma once

#include "optics/transport/phase_trace.h"

namespace lucerna::optics {

/// Traces pilot phases, whose readings are not used for anything else: else the choice would bias
/// the result (DESIGN decision 1).
Plan make_plan(const TraceContext& context, const Settings& settings);

}  // namespace lucerna::optics
