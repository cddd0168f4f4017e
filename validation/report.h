// What a validation found: for a terminal, for programs, and as a page.
#pragma once

#include <string>
#include <vector>

#include "validation/coverage.h"
#include "validation/outcome.h"

namespace lucerna::validation {

/// All that was done, and with what.
struct Report {
    std::vector<CaseOutcome> outcomes;
    RunPlan plan;
    double wall_s = 0.0;
    bool passed() const;
    std::size_t failed_cases() const;
};

/// The families and their cases, with titles and sources.
std::string list_text(const std::vector<Case>& cases);

/// One line per check of the first seed; of further seeds those that failed. Then the coverage.
std::string report_text(const Report& report);

/// Schema: docs/validation.md.
std::string report_json(const Report& report);

/// A page that needs no other file.
std::string report_html(const Report& report);

}  // namespace lucerna::validation
