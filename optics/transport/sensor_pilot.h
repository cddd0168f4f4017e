// Learns how the rays of sensors find light.
#pragma once

#include "optics/transport/phase_trace.h"

namespace lucerna::optics {

/// Traces pilot phases and decides
/// - where rays of illuminance points and luminance meters are scattered to, by where light arrives
///   from;
/// - whether they look for lights behind panes and other specular surfaces themselves
///   (BinRays::looks_for), as where daylight enters through glass: those that the rays of a sensor
///   find often, unless kernels have half the variance. A kernel beside the edge of such light is
///   biased, a ray is not.
/// @param first  of the pilot phases; those with the next lower numbers follow.
void prepare_sensors(const Phase& first, const TraceContext& context, const Settings& settings,
                     Plan& plan);

}  // namespace lucerna::optics
