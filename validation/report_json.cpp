#include <cmath>
#include <nlohmann/json.hpp>

#include "validation/report.h"

namespace lucerna::validation {
namespace {

using nlohmann::ordered_json;

// JSON has no infinities and no nan.
ordered_json number(double value) {
    return std::isfinite(value) ? ordered_json(value) : ordered_json(nullptr);
}

ordered_json json(const Share& share) {
    return {{"hits", share.hits},
            {"trials", share.trials},
            {"fraction", share.fraction()},
            {"lower_95", share.lower()},
            {"upper_95", share.upper()}};
}

ordered_json json(const Run& run, std::size_t check) {
    const CheckOutcome& outcome = run.checks[check];
    const Reading& reading = outcome.reading;
    return {{"seed", run.seed},
            {"value", number(reading.value)},
            {"expanded_uncertainty", number(reading.expanded_uncertainty)},
            {"standard_error", number(reading.standard_error)},
            {"degrees_of_freedom", number(reading.degrees_of_freedom)},
            {"uncorrected_value", number(reading.uncorrected_value)},
            {"uncorrected_standard_error", number(reading.uncorrected_standard_error)},
            {"z", number(outcome.z)},
            {"z_limit", number(outcome.z_limit)},
            {"within_u", outcome.within_u},
            {"verdict", outcome.verdict == Verdict::pass    ? "pass"
                        : outcome.verdict == Verdict::wrong ? "wrong"
                                                            : "too weak"}};
}

ordered_json json(const CaseOutcome& outcome) {
    const Case& own = *outcome.of;
    ordered_json checks = ordered_json::array();
    for (std::size_t i = 0; i < own.checks.size(); ++i) {
        const Check& check = own.checks[i];
        ordered_json entry{{"name", check.name},
                           {"quantity", check.quantity},
                           {"unit", check.unit},
                           {"truth", number(check.truth)},
                           {"truth_error", number(check.truth_error)},
                           {"detects_relative", check.detects_relative}};
        if (check.sweep) {
            entry["sweep"] = {{"curve", check.sweep->curve},
                              {"axis", check.sweep->axis},
                              {"at", check.sweep->at}};
        }
        entry["readings"] = ordered_json::array();
        for (const Run& run : outcome.runs) entry["readings"].push_back(json(run, i));
        checks.push_back(std::move(entry));
    }
    ordered_json runs = ordered_json::array();
    for (const Run& run : outcome.runs) {
        runs.push_back({{"seed", run.seed}, {"phases", run.phases}, {"wall_s", run.wall_s}});
    }
    return {{"id", own.id},
            {"title", own.title},
            {"source", own.source},
            {"passed", outcome.passed()},
            {"runs", std::move(runs)},
            {"checks", std::move(checks)}};
}

}  // namespace

std::string report_json(const Report& report) {
    ordered_json cases = ordered_json::array();
    for (const CaseOutcome& outcome : report.outcomes) cases.push_back(json(outcome));
    ordered_json rows = ordered_json::array();
    for (const Coverage& row : coverage(report.outcomes)) {
        ordered_json entry{{"quantity", row.quantity},
                           {"stated", json(row.stated)},
                           {"noise_only", json(row.noise_only)},
                           {"mean_z", number(row.mean_z)}};
        if (row.relative_width) entry["relative_width"] = number(*row.relative_width);
        rows.push_back(std::move(entry));
    }
    const ordered_json all{{"lucerna", LUCERNA_VERSION},
                           {"seed", report.plan.first_seed},
                           {"seeds", report.plan.seeds},
                           {"accuracy", number(report.plan.accuracy.value_or(std::nan("")))},
                           {"threads", report.plan.threads},
                           {"wall_s", report.wall_s},
                           {"passed", report.passed()},
                           {"coverage", std::move(rows)},
                           {"cases", std::move(cases)}};
    return all.dump(1) + "\n";
}

}  // namespace lucerna::validation
