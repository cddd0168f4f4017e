// Which cases the user means.
#pragma once

#include <string>
#include <vector>

#include "validation/case.h"

namespace lucerna::validation {

/// True if `pattern` is the id, its family, or matches the id or its beginning with '*' for any
/// text and '?' for any character.
bool means(const std::string& pattern, const std::string& id);

/// The cases of all families that patterns may mean, in the order of the list; of all families for
/// no pattern, and if a pattern begins with no family's name. Other truths are not worked out.
std::vector<Case> cases_for(const std::vector<std::string>& patterns);

/// The cases that at least one pattern means, in their own order; all for no pattern. Throws
/// InputError, with the nearest known name, for a pattern that means none.
std::vector<Case> selected(std::vector<Case> cases, const std::vector<std::string>& patterns);

}  // namespace lucerna::validation
