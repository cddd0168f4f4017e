// The closed list of the families of validation cases.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "validation/case.h"

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

struct Family {
    std::string_view name;
    std::string_view proves;  ///< what a pass says about the engine, in a line
    std::vector<Case> (*cases)();
};

std::span<const Family> families();

}  // namespace lucerna::validation
