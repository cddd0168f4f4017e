// The closed list of the families of validation cases.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "validation/case.h"
#include "validation/draw.h"

namespace lucerna::validation {

// Each in cases/FAMILY.cpp.
std::vector<Case> furnace_cases();
std::vector<Case> integrating_sphere_cases();
std::vector<Case> slab_cases();
std::vector<Case> ball_lens_cases();      // in cases/round_lens.cpp
std::vector<Case> cylinder_lens_cases();  // in cases/round_lens.cpp
std::vector<Case> rod_guide_cases();
std::vector<Case> pane_shadow_cases();
std::vector<Case> prism_cases();
std::vector<Case> beer_lambert_cases();
std::vector<Case> invariance_cases();
std::vector<Case> colour_cases();
std::vector<Case> polygon_light_cases();
std::vector<Case> closed_box_cases();
std::vector<Case> cornell_room_cases();
std::vector<Case> grid_cases();  // in cases/grids.cpp
std::vector<Case> pixel_cases();
std::vector<Case> point_source_cases();
std::vector<Case> mirrors_cases();
std::vector<Case> sky_window_cases();
std::vector<Case> cie171_cases();

// With parameters that nobody chose, and the settings that a user's scene has by default.
Case drawn_furnace(const std::string& id, Draw& draw);
Case drawn_integrating_sphere(const std::string& id, Draw& draw);
Case drawn_slab(const std::string& id, Draw& draw);
Case drawn_ball_lens(const std::string& id, Draw& draw);
Case drawn_cylinder_lens(const std::string& id, Draw& draw);
Case drawn_rod_guide(const std::string& id, Draw& draw);
Case drawn_pane_shadow(const std::string& id, Draw& draw);
Case drawn_invariance(const std::string& id, Draw& draw);
Case drawn_polygon_light(const std::string& id, Draw& draw);
Case drawn_closed_box(const std::string& id, Draw& draw);
Case drawn_grid(const std::string& id, Draw& draw);
Case drawn_point_source(const std::string& id, Draw& draw);
Case drawn_mirrors(const std::string& id, Draw& draw);
Case drawn_sky_window(const std::string& id, Draw& draw);

struct Family {
    std::string_view name;
    std::string_view proves;  ///< what a pass says about the engine, in a line
    std::vector<Case> (*cases)();
    Case (*drawn)(const std::string& id, Draw& draw) = nullptr;  ///< where cases can be drawn
};

std::span<const Family> families();

}  // namespace lucerna::validation
