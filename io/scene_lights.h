// The lights of a scene.
#pragma once

#include "io/scene_objects.h"

namespace lucerna::io {

/// Reads the section `lights`. The opening of a luminaire becomes an object of the scene.
void read_lights(SceneContext& context, const SceneObjects& objects, const YamlCursor& section);

/// Rotation from the scene to the frame of the C-gamma system (see IntensityDistribution).
/// @param aim  unit, where gamma = 0 points.
/// @param c0   where the half plane C = 0 points; not along `aim`.
Eigen::Matrix3d to_photometric(const Vec3& aim, const Vec3& c0);

}  // namespace lucerna::io
