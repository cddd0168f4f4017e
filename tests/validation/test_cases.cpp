#include <algorithm>
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

TEST_CASE("Same seed, same drawn cases; their truths are known, and others for other seeds",
          "[validation]") {
    const std::vector<Family> all = families_for({});
    const std::vector<Case> some = drawn_cases(all, 3, 5);
    const std::vector<Case> again = drawn_cases(all, 2, 5);
    const std::vector<Case> others = drawn_cases(all, 3, 6);
    const auto able = static_cast<std::size_t>(
        std::ranges::count_if(all, [](const Family& family) { return family.drawn != nullptr; }));
    CHECK(able >= 10);
    REQUIRE(some.size() == 3 * able);
    REQUIRE(again.size() == 2 * able);
    std::set<std::string> ids;
    for (std::size_t i = 0; i < some.size(); ++i) {
        INFO(some[i].id);
        CHECK(ids.insert(some[i].id).second);
        REQUIRE_FALSE(some[i].checks.empty());
        bool same_as_other_seed = some[i].checks.size() == others[i].checks.size();
        for (std::size_t k = 0; k < some[i].checks.size(); ++k) {
            const Check& check = some[i].checks[k];
            INFO(check.name);
            CHECK(check.truth > 0.0);
            CHECK(std::isfinite(check.truth_error));
            same_as_other_seed = same_as_other_seed && check.truth == others[i].checks[k].truth;
        }
        // A furnace of the same reflectance has the same luminance.
        CHECK_FALSE(same_as_other_seed);
        // Numbers of cases do not depend on how many are drawn.
        if (i % 3 < 2) CHECK(again[i / 3 * 2 + i % 3].checks[0].truth == some[i].checks[0].truth);
    }
}

TEST_CASE("What is drawn is spread evenly within its bounds", "[validation]") {
    Draw draw(1, 1);
    double sum = 0.0, of_logarithms = 0.0, cosines = 0.0;
    constexpr int count = 4000;
    for (int i = 0; i < count; ++i) {
        const double even = draw.between(2.0, 4.0);
        const double log_even = draw.log_between(0.1, 10.0);
        const Vec3 direction = draw.direction(Vec3::UnitX(), 0.5);
        CHECK((even >= 2.0 && even < 4.0 && log_even >= 0.1 && log_even < 10.0));
        CHECK(direction.x() >= std::cos(0.5) - 1e-12);
        sum += even;
        of_logarithms += std::log(log_even);
        cosines += direction.x();
    }
    // Five standard deviations of the means of even distributions.
    const double deviation = 5.0 / std::sqrt(12.0 * count);
    CHECK(std::abs(sum / count - 3.0) < 2.0 * deviation);
    CHECK(std::abs(of_logarithms / count) < 2.0 * std::log(10.0) * deviation);
    CHECK(std::abs(cosines / count - 0.5 * (1.0 + std::cos(0.5))) <
          (1.0 - std::cos(0.5)) * deviation);
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
