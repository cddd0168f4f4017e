// Runs of validation cases, and what each check says of them.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "validation/case.h"

namespace lucerna::validation {

enum class Verdict {
    pass,
    wrong,    ///< differs from the truth by more than its error explains
    too_weak  ///< U is larger than the check accepts: nothing would be found
};
std::string_view verdict_text(Verdict verdict);

struct CheckOutcome {
    Reading reading;
    /// Error in standard uncertainties (JCGM 100:2008, 4.3.7 and 5.1.2):
    ///   z = (value - truth) / sqrt((U / t95)^2 + truth_error^2 / 3)
    double z = 0.0;
    /// |z| that a correct engine exceeds once in a million checks, by Student's t.
    double z_limit = 0.0;
    Verdict verdict = Verdict::pass;
    bool within_u = false;  ///< |value - truth| <= U
};

/// @param accuracy  share of the truth that U may reach whatever the check says.
CheckOutcome judge(const Check& check, const Reading& reading, double accuracy = 0.0);

/// One run of one case.
struct Run {
    std::uint64_t seed;
    double wall_s = 0.0;
    std::uint32_t phases = 0;
    std::vector<CheckOutcome> checks;  ///< in the order of the case's
};

struct CaseOutcome {
    const Case* of;
    std::vector<Run> runs;  ///< one per seed
    bool passed() const;    ///< all checks of all runs
};

struct RunPlan {
    std::uint64_t first_seed = 1;
    std::size_t seeds = 1;  ///< first_seed, first_seed + 1, ...
    int threads = 1;        ///< runs at once; each run has one thread of its own
    /// Instead of a fixed number of phases: until U of all sensors and delta of all images is at
    /// most this share of the value.
    std::optional<double> accuracy = std::nullopt;
    /// In place of the case's own; with an accuracy, the most that a run may take.
    std::optional<std::uint32_t> phases = std::nullopt;
    std::optional<optics::Method> method = std::nullopt;  ///< in place of the case's own
};

/// Runs each case with each seed. The outcome does not depend on the threads but for wall times.
/// @param on_done  called after each run with the number done, from any thread, one at a time.
std::vector<CaseOutcome> run_cases(const std::vector<Case>& cases, const RunPlan& plan,
                                   const std::function<void(std::size_t)>& on_done = {});

}  // namespace lucerna::validation
