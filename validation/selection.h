// Which cases the user means.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "validation/case.h"
#include "validation/cases.h"

namespace lucerna::validation {

/// True if `pattern` is the id, its family, or matches the id or its beginning with '*' for any
/// text and '?' for any character.
bool means(const std::string& pattern, const std::string& id);

/// The families that patterns may mean, in the order of the list; all for no pattern, and if a
/// pattern begins with no family's name.
std::vector<Family> families_for(const std::vector<std::string>& patterns);

/// The cases of families, in their order, with their truths, which are worked out on all threads.
std::vector<Case> cases_of(const std::vector<Family>& families);

/// Cases 1 to `count` of each family that can draw some; their truths as above. Same seed, same
/// cases.
std::vector<Case> drawn_cases(const std::vector<Family>& families, std::uint32_t count,
                              std::uint64_t seed);

/// The cases that at least one pattern means, in their own order; all for no pattern. Throws
/// InputError, with the nearest known name, for a pattern that means none.
std::vector<Case> selected(std::vector<Case> cases, const std::vector<std::string>& patterns);

}  // namespace lucerna::validation
