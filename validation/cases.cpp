#include "validation/cases.h"

#include <array>
#include <iterator>

namespace lucerna::validation {
namespace {

constexpr std::array list{
    Family{"furnace", "interreflection loses and gains nothing, on all shapes", furnace_cases},
    Family{"integrating_sphere", "direct and reflected light of a source in a diffuse sphere",
           integrating_sphere_cases},
};

}  // namespace

std::span<const Family> families() {
    return list;
}

std::vector<Case> all_cases() {
    std::vector<Case> all;
    for (const Family& family : list) {
        std::vector<Case> own = family.cases();
        std::move(own.begin(), own.end(), std::back_inserter(all));
    }
    return all;
}

}  // namespace lucerna::validation
