// Learns which caustic rays the observers can use.
#pragma once

#include "optics/transport/phase_trace.h"
#include "optics/transport/radii.h"

namespace lucerna::optics {

/// Points whose kernels observers gather from, as vertices that take all light.
struct SeenPoints {
    std::vector<BackwardPhoton> vertices;  ///< `bin` of an illuminance point: its index
    std::vector<std::uint32_t> targets;    ///< of each: what wants its own variance to be small
    std::vector<bool> of_images;           ///< of each target
    std::uint32_t target_count() const { return static_cast<std::uint32_t>(of_images.size()); }
};

/// Where some rays of each camera and meter meet a scattering surface, and illuminance points. An
/// image is one target, a meter is one, and so is each illuminance point.
SeenPoints seen_points(const Phase& phase, const TraceContext& context, const Settings& settings);

/// Traces rays of a pilot phase and looks up which of their photons fall into kernels that
/// observers gather from, and how much of the observers' variance those make: the guide lowers the
/// sum of the relative variances of all images, meters and illuminance points.
/// @param radii   about those of the kernels.
/// @param photons of all light, to tell how much light the observers have.
/// Empty if no observer sees caustics.
EmissionGuide guide_of_caustics(const Phase& phase, const TraceContext& context,
                                const SeenPoints& seen, const Radii& radii,
                                const PilotPhotons& photons);

}  // namespace lucerna::optics
