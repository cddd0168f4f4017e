// A point light through a wide pane, and a screen with a sharp shadow.
#pragma once

#include "validation/scene_builder.h"
#include "validation/truth/pane_shadow.h"

namespace lucerna::validation {

/// No ray finds the light behind the glass: all is read by kernels. The pane is so wide, and so
/// near to the lamp, that light by way of its rim lands far away.
inline SceneBuilder pane_and_screen(const truth::PaneShadow& shadow) {
    using optics::Rectangle;
    constexpr double pane_m = 3.0, pane_height_m = 0.7;
    SceneBuilder scene;
    scene.object("floor", Rectangle{{-2, -2, 0}, {4, 0, 0}, {0, 4, 0}}, scene.black());
    scene.solid(
        "pane",
        optics::Box{Placement(Eigen::Translation3d(-0.5 * pane_m, -0.5 * pane_m, pane_height_m)),
                    {pane_m, pane_m, shadow.pane_thickness_m}},
        scene.medium(shadow.pane_index));
    scene.object(
        "screen",
        Rectangle{{shadow.screen_edge_m, -1, shadow.screen_height_m}, {0.6, 0, 0}, {0, 2, 0}},
        scene.black());
    scene.light("lamp", optics::PointLight{{0, 0, shadow.lamp_height_m}},
                4.0 * pi * shadow.intensity_cd);
    return scene;
}

}  // namespace lucerna::validation
