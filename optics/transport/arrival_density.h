// Learns from where indirect light arrives at what sensors see.
#pragma once

#include "optics/transport/emission_pilot.h"

namespace lucerna::optics {

/// Scatters the rays of illuminance points and luminance meters to where light arrives from.
///
/// A small bright spot of a ceiling, or a diffuser, is met by few rays that follow the cosine
/// alone, and those few make the noise of a sensor. Directions are learned from the photons that
/// arrive around; in a grid as fine as lets one half of them foretell the other best (by the
/// likelihood). Three in ten rays follow the cosine whatever was learned, so that none weighs
/// more than 4 times the usual.
/// @param seen    tells where meters look.
/// @param pilot   photons of independent rays; of those that came by specular events alone count
///                the ones of lights that the rays of a sensor look for.
void scatter_to_arrivals(const Phase& phase, const TraceContext& context, const SeenPoints& seen,
                         const PilotPhotons& pilot, BackwardRays& rays);

}  // namespace lucerna::optics
