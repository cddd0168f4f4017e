#include "validation/selection.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "core/diagnostics.h"
#include "core/parallel.h"

namespace lucerna::validation {
namespace {

std::string family_of(const std::string& id) {
    return id.substr(0, id.find('/'));
}

// The pattern matches a beginning of the text.
bool matches_beginning(std::string_view pattern, std::string_view text) {
    if (pattern.empty()) return true;
    if (pattern[0] == '*') {
        for (std::size_t skip = 0; skip <= text.size(); ++skip) {
            if (matches_beginning(pattern.substr(1), text.substr(skip))) return true;
        }
        return false;
    }
    return !text.empty() && (pattern[0] == '?' || pattern[0] == text[0]) &&
           matches_beginning(pattern.substr(1), text.substr(1));
}

}  // namespace

bool means(const std::string& pattern, const std::string& id) {
    if (pattern == id || pattern == family_of(id)) return true;
    return pattern.find_first_of("*?") != std::string::npos && matches_beginning(pattern, id);
}

std::vector<Family> families_for(const std::vector<std::string>& patterns) {
    const auto is_family = [](const std::string& name) {
        return std::any_of(families().begin(), families().end(),
                           [&](const Family& family) { return family.name == name; });
    };
    const bool some = !patterns.empty() &&
                      std::all_of(patterns.begin(), patterns.end(), [&](const auto& pattern) {
                          return is_family(family_of(pattern));
                      });
    std::vector<Family> wanted;
    for (const Family& family : families()) {
        if (!some || std::any_of(patterns.begin(), patterns.end(), [&](const auto& pattern) {
                return family_of(pattern) == family.name;
            })) {
            wanted.push_back(family);
        }
    }
    return wanted;
}

std::vector<Case> cases_of(const std::vector<Family>& families) {
    std::vector<std::vector<Case>> by_family(families.size());
    for_each_block(families.size(), hardware_threads(),
                   [&](std::size_t i) { by_family[i] = families[i].cases(); });
    std::vector<Case> cases;
    for (std::vector<Case>& own : by_family) {
        std::move(own.begin(), own.end(), std::back_inserter(cases));
    }
    return cases;
}

std::vector<Case> drawn_cases(const std::vector<Family>& families, std::uint32_t count,
                              std::uint64_t seed) {
    std::vector<Family> able;
    std::ranges::copy_if(families, std::back_inserter(able),
                         [](const Family& family) { return family.drawn != nullptr; });
    // Beside a fold or a shadow U is what it is; that it holds is the point.
    constexpr double detects_relative = 0.3;
    std::vector<Case> cases(able.size() * count);
    for_each_block(cases.size(), hardware_threads(), [&](std::size_t i) {
        const auto number = static_cast<std::uint32_t>(i % count + 1);
        const Family& family = able[i / count];
        Draw draw(seed, number);
        cases[i] = family.drawn(fmt::format("{}/drawn-{}", family.name, number), draw);
        for (Check& check : cases[i].checks) check.detects_relative = detects_relative;
    });
    return cases;
}

std::vector<Case> selected(std::vector<Case> cases, const std::vector<std::string>& patterns) {
    std::vector<std::string> names;
    for (const Case& own : cases) {
        if (names.empty() || family_of(names.back()) != family_of(own.id)) {
            names.push_back(family_of(own.id));
        }
        names.push_back(own.id);
    }
    Diagnostics problems;
    for (const std::string& pattern : patterns) {
        if (std::any_of(names.begin(), names.end(),
                        [&](const std::string& name) { return means(pattern, name); })) {
            continue;
        }
        const std::string nearest = nearest_word(pattern, names);
        problems.add({"validate"},
                     fmt::format("no case is called '{}'; {}", pattern,
                                 nearest.empty() ? "--list shows them all"
                                                 : fmt::format("did you mean '{}'?", nearest)));
    }
    problems.throw_if_any();
    if (patterns.empty()) return cases;
    std::erase_if(cases, [&](const Case& own) {
        return std::none_of(patterns.begin(), patterns.end(),
                            [&](const std::string& pattern) { return means(pattern, own.id); });
    });
    return cases;
}

}  // namespace lucerna::validation
