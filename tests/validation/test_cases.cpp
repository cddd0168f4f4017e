#include <catch2/catch.hpp>
#include <set>

#include "validation/cases.h"
#include "validation/selection.h"

using namespace lucerna;
using namespace lucerna::validation;

TEST_CASE("Each family has cases at two parameter sets, each id and check is unique",
          "[validation]") {
    std::set<std::string> ids;
    for (const Family& family : families()) {
        INFO(family.name);
        const std::vector<Case> cases = family.cases();
        CHECK(cases.size() >= 2);
        CHECK_FALSE(family.proves.empty());
        for (const Case& own : cases) {
            INFO(own.id);
            CHECK(own.id.starts_with(std::string(family.name) + "/"));
            CHECK(ids.insert(own.id).second);
            CHECK_FALSE(own.source.empty());
            CHECK_FALSE(own.checks.empty());
            std::set<std::string> names;
            for (const Check& check : own.checks) {
                INFO(check.name);
                CHECK(names.insert(check.name).second);
                CHECK(std::isfinite(check.truth));
                // A truth must be known much better than what it judges.
                CHECK(check.truth_error <= 0.1 * check.detects_relative * std::abs(check.truth));
            }
        }
    }
}

TEST_CASE("The families that are promised are in the list", "[validation]") {
    for (const char* name : {"furnace", "integrating_sphere", "polygon_light", "closed_box",
                             "cornell_room", "point_source", "mirrors", "sky_window", "cie171"}) {
        INFO(name);
        CHECK(std::any_of(families().begin(), families().end(),
                          [&](const Family& family) { return family.name == name; }));
    }
}

TEST_CASE("Only truths of families that may be meant are worked out", "[validation]") {
    const auto names_for = [](const std::vector<std::string>& patterns) {
        std::vector<std::string> names;
        for (const Family& family : families_for(patterns)) names.emplace_back(family.name);
        return names;
    };
    CHECK(names_for({"mirrors/two-point", "beer_lambert"}) ==
          std::vector<std::string>{"beer_lambert", "mirrors"});
    CHECK(names_for({"mirrors/no-such-case"}) == std::vector<std::string>{"mirrors"});
    CHECK(names_for({}).size() == families().size());
    CHECK(names_for({"mirrors", "mir*"}).size() == families().size());
    // Those of one family, and of that one alone.
    const std::vector<Case> cases = cases_of(families_for({"mirrors/two-point"}));
    REQUIRE_FALSE(cases.empty());
    for (const Case& own : cases) CHECK(means("mirrors", own.id));
}

TEST_CASE("Cases are chosen by id, family and pattern", "[validation]") {
    CHECK(means("slab", "slab/60-deg"));
    CHECK(means("slab/60-deg", "slab/60-deg"));
    CHECK(means("slab/6*", "slab/60-deg"));
    CHECK(means("sl?b", "slab/60-deg"));
    CHECK(means("*deg", "slab/60-deg"));
    CHECK_FALSE(means("sla", "slab/60-deg"));
    CHECK_FALSE(means("*/7", "slab/60-deg"));
    CHECK_FALSE(means("", "slab/60-deg"));
}
