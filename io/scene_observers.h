// Cameras and sensors.
#pragma once

#include "io/scene_objects.h"

namespace lucerna::io {

/// Reads the section `cameras`.
void read_cameras(SceneContext& context, const YamlCursor& section);

/// Reads the section `sensors`.
void read_sensors(SceneContext& context, const SceneObjects& objects, const YamlCursor& section);

/// Largest spacing of illuminance points by EN 12464-1:2021, 4.4, eq. (2): p = 0.2 * 5^log10(d) and
/// at most 10 m; d is the longer side of the area, or the shorter one if the ratio is 2 or more.
double en12464_spacing_m(double side_m, double other_side_m);

}  // namespace lucerna::io
