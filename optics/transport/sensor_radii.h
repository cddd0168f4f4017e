// Kernels that sensors read caustics with.
#pragma once

#include <span>

#include "optics/transport/radii.h"

namespace lucerna::optics {

/// A point that a sensor reads caustics at.
struct ReadPoint {
    SurfacePoint point;
    std::uint32_t sensor_point;  ///< its index if it lies on a plane
};

/// Radii with other kernels around points that are to be read with little error: such that the
/// accuracy is reached after the fewest phases, but at least half as wide as they were; on surfaces
/// in the mean over the points of a patch, on sensor planes at each point by itself. Two pilots
/// that are independent of each other, of as many rays each, tell the square of the bias by a
/// product, whatever the noise of each is.
/// @param accuracy  relative expanded uncertainty that is asked for.
/// @param rays      of a phase.
Radii widened_around(const Stage& stage, const SensorPlanes& planes, const Radii& radii,
                     const PilotPhotons& one, const PilotPhotons& other,
                     std::span<const ReadPoint> points, double accuracy, std::uint32_t rays,
                     int threads);

}  // namespace lucerna::optics
