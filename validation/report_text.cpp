#include <fmt/format.h>

#include <algorithm>

#include "io/measured_value.h"
#include "validation/cases.h"
#include "validation/report.h"

namespace lucerna::validation {
namespace {

// Columns that a terminal shows, not bytes: a character of UTF-8 begins once.
std::size_t columns(const std::string& text) {
    return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
        return (static_cast<unsigned char>(c) & 0xC0) != 0x80;
    }));
}

std::string padded(const std::string& text, std::size_t width) {
    return text + std::string(width - std::min(width, columns(text)), ' ');
}

std::string truth_text(const Check& check) {
    return io::measured_value(check.truth, check.truth_error);
}

std::string line(const Check& check, const CheckOutcome& outcome, std::size_t name_width) {
    return fmt::format(
        "  {} {} {} {} {} {:>6.2f}  {}\n", padded(check.name, name_width),
        padded(check.quantity, 13), padded(truth_text(check), 22),
        padded(io::measured_value(outcome.reading.value, outcome.reading.expanded_uncertainty), 22),
        padded(check.unit, 6), outcome.z, verdict_text(outcome.verdict));
}

std::string percent(const Share& share) {
    return fmt::format("{:5.1f} % ({:.1f} to {:.1f})", 100.0 * share.fraction(),
                       100.0 * share.lower(), 100.0 * share.upper());
}

std::string coverage_text(const Report& report) {
    const std::vector<Coverage> rows = coverage(report.outcomes);
    if (rows.empty()) return "";
    const Share& all = rows.back().stated;
    const auto [low, high] = binomial_bounds(all.trials, 0.95);
    std::string text = fmt::format(
        "\n{} of {} readings with a truth known to U / 4 lie within U (95 % expected: {} to {})\n",
        all.hits, all.trials, low, high);
    if (report.plan.seeds < 2) return text;
    text += fmt::format("\nCoverage over {} seeds, with the 95 % interval of each share\n",
                        report.plan.seeds);
    text +=
        fmt::format("  {} {} {} {:>7} {:>12}\n", padded("quantity", 18), padded("value ± U", 24),
                    padded("eq. 5 alone", 24), "mean z", "U/(1.96 sd)");
    for (const Coverage& row : rows) {
        text += fmt::format("  {} {} {} {:>7.2f} {:>12}\n", padded(row.quantity, 18),
                            padded(percent(row.stated), 24), padded(percent(row.noise_only), 24),
                            row.mean_z,
                            row.relative_width ? fmt::format("{:.2f}", *row.relative_width) : "-");
    }
    return text;
}

}  // namespace

bool Report::passed() const {
    return failed_cases() == 0;
}

std::size_t Report::failed_cases() const {
    return static_cast<std::size_t>(
        std::count_if(outcomes.begin(), outcomes.end(),
                      [](const CaseOutcome& outcome) { return !outcome.passed(); }));
}

std::string list_text(const std::vector<Case>& cases) {
    std::string text;
    for (const Family& family : families()) {
        std::string of_family;
        for (const Case& own : cases) {
            if (!own.id.starts_with(std::string(family.name) + "/")) continue;
            of_family += fmt::format("  {:<34} {}\n", own.id, own.title);
        }
        if (!of_family.empty()) {
            text += fmt::format("{}: {}\n{}", family.name, family.proves, of_family);
        }
    }
    return text;
}

std::string report_text(const Report& report) {
    std::string text;
    for (const CaseOutcome& outcome : report.outcomes) {
        const Case& own = *outcome.of;
        std::size_t name_width = 5;
        for (const Check& check : own.checks)
            name_width = std::max(name_width, columns(check.name));
        text += fmt::format("{}: {}  [{:.1f} s]\n  truth: {}\n", own.id, own.title,
                            outcome.runs.front().wall_s, own.source);
        text += fmt::format("  {} {} {} {} {} {:>6}  {}\n", padded("check", name_width),
                            padded("quantity", 13), padded("truth ± its error", 22),
                            padded("measured ± U (95 %)", 22), padded("unit", 6), "z", "verdict");
        for (const Run& run : outcome.runs) {
            const bool first = &run == &outcome.runs.front();
            for (std::size_t i = 0; i < own.checks.size(); ++i) {
                if (!first && run.checks[i].verdict == Verdict::pass) continue;
                if (!first) text += fmt::format("  seed {}:\n", run.seed);
                text += line(own.checks[i], run.checks[i], name_width);
            }
        }
        text += "\n";
    }
    const std::size_t failed = report.failed_cases();
    text += fmt::format("{} of {} cases passed, {:.0f} s of wall time on {} thread{}, seed {}{}\n",
                        report.outcomes.size() - failed, report.outcomes.size(), report.wall_s,
                        report.plan.threads, report.plan.threads == 1 ? "" : "s",
                        report.plan.first_seed,
                        report.plan.seeds > 1
                            ? fmt::format(" to {}", report.plan.first_seed + report.plan.seeds - 1)
                            : "");
    text += coverage_text(report);
    for (const CaseOutcome& outcome : report.outcomes) {
        if (!outcome.passed()) text += fmt::format("FAILED {}\n", outcome.of->id);
    }
    return text;
}

}  // namespace lucerna::validation
