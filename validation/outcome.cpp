#include "validation/outcome.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <mutex>

#include "core/parallel.h"
#include "core/statistics.h"
#include "optics/transport/simulate.h"

namespace lucerna::validation {
namespace {

constexpr double level = 1e-6;

// Beyond a million degrees of freedom Student's t is the normal distribution to all digits shown.
double quantile(double coverage, double degrees_of_freedom) {
    return student_t(coverage, std::clamp(degrees_of_freedom, 1.0, 1e6));
}

Run run_case(const Case& own, std::uint64_t seed, const RunPlan& plan) {
    optics::Settings settings = own.settings;
    settings.seed = seed;
    settings.threads = 1;
    if (plan.method) settings.method = *plan.method;
    if (plan.accuracy) {
        settings.sensor_accuracy = settings.image_accuracy = plan.accuracy;
        settings.max_phases = std::nullopt;
    }
    if (plan.phases) settings.max_phases = plan.phases;
    const auto start = std::chrono::steady_clock::now();
    const optics::Result result = optics::simulate(own.scene, settings);
    Run run{
        .seed = seed,
        .wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(),
        .phases = result.phases,
        .checks = {}};
    for (const Check& check : own.checks) {
        run.checks.push_back(judge(check, check.read(result), plan.accuracy.value_or(0.0)));
    }
    return run;
}

}  // namespace

std::string_view verdict_text(Verdict verdict) {
    switch (verdict) {
        case Verdict::pass:
            return "pass";
        case Verdict::wrong:
            return "WRONG";
        case Verdict::too_weak:
            return "TOO WEAK";
    }
    return "";
}

CheckOutcome judge(const Check& check, const Reading& reading, double accuracy) {
    const double error = reading.value - check.truth;
    const double expanded = reading.expanded_uncertainty;
    const double standard = expanded / quantile(0.95, reading.degrees_of_freedom);
    // The truth's error is known by its bound only: a rectangular distribution.
    const double both = std::sqrt(standard * standard + check.truth_error * check.truth_error / 3);
    CheckOutcome outcome{.reading = reading,
                         .z = error == 0.0 ? 0.0 : error / both,
                         .z_limit = quantile(1.0 - level, reading.degrees_of_freedom),
                         .verdict = Verdict::pass,
                         .within_u = std::abs(error) <= expanded};
    // Written so that what is not a number fails.
    if (!(std::abs(outcome.z) <= outcome.z_limit)) {
        outcome.verdict = Verdict::wrong;
    } else if (!(expanded <= std::max(check.detects_relative, accuracy) * std::abs(check.truth))) {
        outcome.verdict = Verdict::too_weak;
    }
    return outcome;
}

bool CaseOutcome::passed() const {
    return std::all_of(runs.begin(), runs.end(), [](const Run& run) {
        return std::all_of(run.checks.begin(), run.checks.end(), [](const CheckOutcome& check) {
            return check.verdict == Verdict::pass;
        });
    });
}

std::vector<CaseOutcome> run_cases(const std::vector<Case>& cases, const RunPlan& plan,
                                   const std::function<void(std::size_t)>& on_done) {
    std::vector<CaseOutcome> outcomes;
    for (const Case& own : cases) outcomes.push_back({&own, std::vector<Run>(plan.seeds)});
    std::mutex mutex;
    std::size_t done = 0;
    for_each_block(cases.size() * plan.seeds, plan.threads, [&](std::size_t block) {
        const std::size_t number = block / plan.seeds;
        const std::size_t seed = block % plan.seeds;
        outcomes[number].runs[seed] = run_case(cases[number], plan.first_seed + seed, plan);
        const std::scoped_lock lock(mutex);
        ++done;
        if (on_done) on_done(done);
    });
    return outcomes;
}

}  // namespace lucerna::validation
