// The command validate: the engine against truths that were derived without it.
#include <fmt/format.h>

#include "cli/commands.h"
#include "cli/progress_line.h"
#include "cli/results_folder.h"
#include "core/parallel.h"
#include "core/stopwatch.h"
#include "io/atomic_file.h"
#include "validation/cases.h"
#include "validation/report.h"
#include "validation/selection.h"

namespace lucerna::cli {

ExitCode validate(const ValidateOptions& options) {
    const auto families = validation::families_for(options.cases);
    const std::vector<validation::Case> cases = validation::selected(
        options.draw ? validation::drawn_cases(families, *options.draw, options.seed)
                     : validation::cases_of(families),
        options.cases);
    if (options.list) {
        fmt::print("{}", validation::list_text(cases));
        return done;
    }
    if (options.output) make_folder(*options.output);  // not to find out at the end

    validation::RunPlan plan;
    plan.first_seed = options.seed;
    plan.seeds = options.seeds;
    plan.accuracy = options.accuracy;
    plan.phases = options.phases;
    if (options.draw && !plan.accuracy && !plan.phases) {
        // Nobody chose an effort for what is drawn; some of it is too faint ever to be that
        // accurate.
        plan.accuracy = 0.01;
        plan.phases = 256;
    }
    plan.method = options.method;
    plan.threads = options.threads.value_or(hardware_threads());
    const std::size_t runs = cases.size() * plan.seeds;
    const Stopwatch watch;
    validation::Report report;
    report.plan = plan;
    {
        ProgressLine line;
        report.outcomes = validation::run_cases(cases, plan, [&](std::size_t run) {
            const double elapsed_s = watch.seconds();
            line.show(fmt::format("{} of {} runs, {}", run, runs, duration_text(elapsed_s)),
                      elapsed_s);
        });
    }
    report.wall_s = watch.seconds();
    fmt::print("{}", validation::report_text(report));
    if (options.output) {
        const auto json = *options.output / "validation.json";
        const auto page = *options.output / "validation.html";
        io::write_file(json, validation::report_json(report));
        io::write_file(page, validation::report_html(report));
        fmt::print("\nWritten\n  {}\n  {}\n", json.string(), page.string());
    }
    return report.passed() ? done : validation_failed;
}

}  // namespace lucerna::cli
