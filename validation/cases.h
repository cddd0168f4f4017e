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

struct Family {
    std::string_view name;
    std::string_view proves;  ///< what a pass says about the engine, in a line
    std::vector<Case> (*cases)();
};

std::span<const Family> families();

/// All cases of all families, in the order of the list.
std::vector<Case> all_cases();

}  // namespace lucerna::validation
