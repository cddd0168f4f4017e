// Learns which caustic rays the observers can use.
#pragma once

#include "optics/transport/phase_trace.h"
#include "optics/transport/radii.h"

namespace lucerna::optics {

/// Traces rays of a pilot phase and looks up which of their photons fall into kernels that
/// observers gather from, and how much of the observers' variance those make: the guide lowers the
/// sum of the relative variances of all images, meters and illuminance points.
/// @param radii   about those of the kernels.
/// @param photons of all light, to tell how much light the observers have.
/// Empty if no observer sees caustics.
EmissionGuide guide_of_caustics(const Phase& phase, const TraceContext& context,
                                const Settings& settings, const Radii& radii,
                                const PilotPhotons& photons);

}  // namespace lucerna::optics
