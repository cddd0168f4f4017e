#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "io/measured_value.h"
#include "validation/plot.h"
#include "validation/report.h"

namespace lucerna::validation {
namespace {

using plot::escaped;

constexpr const char* style = R"(
body { font: 15px/1.45 system-ui, sans-serif; color: #222; max-width: 76rem; margin: 2rem auto; padding: 0 1rem; }
table { border-collapse: collapse; margin: 0.6rem 0 1.4rem; }
th, td { text-align: left; padding: 0.15rem 0.9rem 0.15rem 0; border-bottom: 1px solid #ddd; font-variant-numeric: tabular-nums; }
h3 { margin: 1.4rem 0 0; font-size: 1rem; } .source { color: #555; }
.pass { color: #15803d; } .fail { color: #fff; background: #b91c1c; padding: 0 0.4rem; font-weight: bold; }
.plots { display: flex; flex-wrap: wrap; gap: 1.5rem; } svg { max-width: 100%; height: auto; }
)";

std::string case_html(const CaseOutcome& outcome) {
    const Case& own = *outcome.of;
    std::string text = fmt::format(
        "<h3 id=\"{0}\">{0}</h3>\n<div>{1}</div>\n<div class=\"source\">Truth: {2}</div>\n"
        "<table><tr><th>check</th><th>quantity</th><th>truth ± its error</th><th>measured ± U (95 "
        "%)</th><th>unit</th><th>z</th><th>verdict</th></tr>\n",
        escaped(own.id), escaped(own.title), escaped(own.source));
    for (const Run& run : outcome.runs) {
        const bool first = &run == &outcome.runs.front();
        for (std::size_t i = 0; i < own.checks.size(); ++i) {
            const Check& check = own.checks[i];
            const CheckOutcome& found = run.checks[i];
            const bool pass = found.verdict == Verdict::pass;
            if (!first && pass) continue;
            text += fmt::format(
                "<tr><td>{}{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{:.2f}</td>"
                "<td><span class=\"{}\">{}</span></td></tr>\n",
                escaped(check.name), first ? "" : fmt::format(" (seed {})", run.seed),
                escaped(check.quantity), io::measured_value(check.truth, check.truth_error),
                io::measured_value(found.reading.value, found.reading.expanded_uncertainty),
                escaped(check.unit), found.z, pass ? "pass" : "fail", verdict_text(found.verdict));
        }
    }
    return text + "</table>\n";
}

std::string coverage_html(const Report& report) {
    std::string text =
        "<table><tr><th>quantity</th><th>readings</th><th>within value ± U</th><th>95 % "
        "interval</th><th>within eq. 5 alone</th><th>95 % interval</th><th>mean z</th>"
        "<th>U / (1.96 sd)</th></tr>\n";
    for (const Coverage& row : coverage(report.outcomes)) {
        text += fmt::format(
            "<tr><td>{}</td><td>{}</td><td>{:.1f} %</td><td>{:.1f} to {:.1f} %</td><td>{:.1f} "
            "%</td><td>{:.1f} to {:.1f} %</td><td>{:.2f}</td><td>{}</td></tr>\n",
            escaped(row.quantity), row.stated.trials, 100.0 * row.stated.fraction(),
            100.0 * row.stated.lower(), 100.0 * row.stated.upper(),
            100.0 * row.noise_only.fraction(), 100.0 * row.noise_only.lower(),
            100.0 * row.noise_only.upper(), row.mean_z,
            row.relative_width ? fmt::format("{:.2f}", *row.relative_width) : "");
    }
    return text + "</table>\n";
}

std::string plots_html(const Report& report) {
    plot::Histogram z{"z of all checks, and the normal distribution", "z", -5.0, 5.0, 20, {}, true};
    plot::Histogram ratio{"True error over stated U", "|error| / U", 0.0, 2.5, 25, {}, false};
    plot::Rows rows{"True error over stated U, per case (first seed)", "|error| / U", 2.5, 1.0, {}};
    std::map<std::string, plot::Curve> curves;
    for (const CaseOutcome& outcome : report.outcomes) {
        const Case& own = *outcome.of;
        plot::Rows::Row row{own.id, {}};
        for (const Run& run : outcome.runs) {
            const bool first = &run == &outcome.runs.front();
            for (std::size_t i = 0; i < own.checks.size(); ++i) {
                const Check& check = own.checks[i];
                const Reading& reading = run.checks[i].reading;
                const double share =
                    std::abs(reading.value - check.truth) / reading.expanded_uncertainty;
                z.values.push_back(run.checks[i].z);
                ratio.values.push_back(share);
                if (!first || !std::isfinite(share)) continue;
                row.values.push_back(share);
                if (!check.sweep) continue;
                plot::Curve& curve = curves[check.sweep->curve];
                curve.title = check.sweep->curve;
                curve.x_axis = check.sweep->axis;
                curve.y_axis = check.unit.empty() || check.unit == "1"
                                   ? check.quantity
                                   : check.quantity + " [" + check.unit + "]";
                curve.points.push_back(
                    {check.sweep->at, check.truth, reading.value, reading.expanded_uncertainty});
            }
        }
        rows.rows.push_back(std::move(row));
    }
    std::string text = "<div class=\"plots\">\n" + svg(z) + svg(ratio) + svg(rows);
    if (report.plan.seeds > 1) {
        plot::Intervals stated{
            "Coverage of value ± U, with its 95 % interval", "%", 80, 100, 95, {}};
        plot::Intervals noise{
            "Coverage of eq. 5 alone, with its 95 % interval", "%", 50, 100, 95, {}};
        for (const Coverage& row : coverage(report.outcomes)) {
            const auto add = [&](plot::Intervals& intervals, const Share& share) {
                intervals.rows.push_back({row.quantity, 100.0 * share.lower(),
                                          100.0 * share.fraction(), 100.0 * share.upper()});
            };
            add(stated, row.stated);
            add(noise, row.noise_only);
        }
        text += svg(stated) + svg(noise);
    }
    for (const auto& [name, curve] : curves) {
        if (curve.points.size() > 2) text += svg(curve);
    }
    return text + "</div>\n";
}

}  // namespace

std::string report_html(const Report& report) {
    const std::size_t failed = report.failed_cases();
    std::string text = fmt::format(
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>Lucerna "
        "validation</title><style>{}</style></head><body>\n<h1>Lucerna {} validation</h1>\n"
        "<p><b>{} of {} cases passed.</b> Seed {}, {} seed{} per case, {:.0f} s of wall time on {} "
        "threads. Truths come from closed forms and quadrature, not from the engine. "
        "z = (measured - truth) / standard uncertainty; a check fails beyond the 1e-6 level, or if "
        "its U is too large to find anything.</p>\n",
        style, LUCERNA_VERSION, report.outcomes.size() - failed, report.outcomes.size(),
        report.plan.first_seed, report.plan.seeds, report.plan.seeds == 1 ? "" : "s", report.wall_s,
        report.plan.threads);
    text += "<h2>Coverage</h2>\n" + coverage_html(report);
    text += "<h2>Plots</h2>\n" + plots_html(report);
    text += "<h2>Cases</h2>\n";
    for (const CaseOutcome& outcome : report.outcomes) text += case_html(outcome);
    return text + "</body></html>\n";
}

}  // namespace lucerna::validation
