#include <fmt/format.h>

#include <cmath>

#include "io/benchmark_report.h"
#include "io/measured_value.h"
#include "io/setting_names.h"
#include "io/text_table.h"

namespace lucerna::io {
namespace {

using Cells = std::vector<std::string>;  // of one row

std::string threads_text(int threads) {
    return fmt::format("{} thread{}", threads, threads == 1 ? "" : "s");
}

// A number of items, of which a part goes through so many per second.
Cells rate_row(const std::string& name, const optics::Rate& rate, std::size_t columns) {
    Cells row{name, fmt::format("{}", rate.items)};
    for (const double per_s : rate.per_s) row.push_back(fmt::format("{:.3g}", per_s * 1e-6));
    row.resize(2 + columns, "-");
    return row;
}

std::string rates_text(const optics::Rates& rates, int repetitions) {
    const std::size_t columns = rates.threads.size();
    Cells header{"", "items"};
    for (const int threads : rates.threads) header.push_back(threads_text(threads));
    std::vector<Cells> rows{header};
    const auto add = [&](const char* name, const optics::Rate& rate) {
        rows.push_back(rate_row(name, rate, columns));
    };
    const auto add_fraction = [&](const char* name, const optics::TraceRates& trace) {
        if (trace.traced.items == 0) return;
        Cells row{name, ""};
        for (std::size_t i = 0; i < columns; ++i) {
            row.push_back(fmt::format("{:.0f} %", 100.0 * trace.fraction(i)));
        }
        rows.push_back(row);
    };
    add("forward rays, bare cast", rates.forward.bare);
    add("forward rays, traced", rates.forward.traced);
    add_fraction("  traced / bare", rates.forward);
    add("backward rays, bare cast", rates.backward.bare);
    add("backward rays, traced", rates.backward.traced);
    add_fraction("  traced / bare", rates.backward);
    add("backward map, vertices built in", rates.backward_map.build);
    add("backward map, photons looked up", rates.backward_map.find);
    add("backward map, deposits applied", rates.backward_map.deposit);
    add("caustic map, photons built in", rates.caustic_map.build);
    add("caustic map, gathers", rates.caustic_map.gather);
    add("indirect map, photons built in", rates.indirect_map.build);
    add("indirect map, gathers", rates.indirect_map.gather);
    return fmt::format("Each part by itself, millions per second, best of {}\n", repetitions) +
           text_table(rows);
}

// Rows of the table of runs: a column for each run, filled by what is given for one.
class RunTable {
public:
    explicit RunTable(const std::vector<optics::TimedRun>& runs) : runs_(runs) {}

    template <typename Cell>
    void add(const std::string& name, const Cell& cell) {
        Cells row{name};
        for (const optics::TimedRun& run : runs_) row.push_back(cell(run));
        rows_.push_back(row);
    }

    // Seconds per phase and their share of the phase.
    template <typename Seconds>
    void add_stage(const std::string& name, const Seconds& seconds) {
        add(name, [&](const optics::TimedRun& run) {
            const optics::RunMeasure& m = run.fastest();
            const double stage_s = seconds(m) / m.phases;
            return fmt::format("{:.4f} s {:3.0f} %", stage_s, 100.0 * stage_s / m.phase_s());
        });
    }

    std::string text() const { return text_table(rows_); }

private:
    const std::vector<optics::TimedRun>& runs_;
    std::vector<Cells> rows_;
};

std::string expected_text(const optics::RunMeasure& m, double delta) {
    if (m.accuracy_reached) return fmt::format("{:.3g} s", m.wall_s);
    const double expected_s = m.expected_s(delta);
    return std::isfinite(expected_s) ? fmt::format("~ {:.3g} s", expected_s) : "-";
}

std::string factor_text(double factor) {
    return std::isfinite(factor) ? fmt::format("{:.2f} x", factor) : "-";
}

std::string runs_text(const std::vector<optics::TimedRun>& runs, const BenchmarkPlan& plan) {
    using optics::RunMeasure;
    using optics::TimedRun;
    RunTable table(runs);
    table.add("method", [](const TimedRun& run) { return name_of(run.method); });
    table.add("scheduler", [](const TimedRun& run) { return name_of(run.scheduler); });
    table.add("threads", [](const TimedRun& run) { return fmt::format("{}", run.threads); });
    table.add("setup", [](const TimedRun& run) {
        return fmt::format("{:.4f} s", run.fastest().rays.setup_s);
    });
    table.add("pilot phases", [](const TimedRun& run) {
        return fmt::format("{:.4f} s", run.fastest().rays.pilot_s);
    });
    table.add("phases",
              [](const TimedRun& run) { return fmt::format("{}", run.fastest().phases); });
    table.add_stage("a phase", [](const RunMeasure& m) { return m.phase_s() * m.phases; });
    table.add_stage("  forward traces for maps",
                    [](const RunMeasure& m) { return m.rays.caustic_s; });
    table.add_stage("  maps built", [](const RunMeasure& m) { return m.rays.maps_s; });
    table.add_stage("  backward trace", [](const RunMeasure& m) { return m.rays.backward_s; });
    table.add_stage("  secondary trace, deposits",
                    [](const RunMeasure& m) { return m.rays.secondary_s; });
    table.add_stage("  images", [](const RunMeasure& m) { return m.rays.readings_s; });
    table.add_stage("  rest", [](const RunMeasure& m) { return m.rest_s(); });
    const auto per_phase = [](std::uint64_t count, const RunMeasure& m) {
        return fmt::format("{}", count / m.phases);
    };
    table.add("  photons in forward maps", [&](const TimedRun& run) {
        return per_phase(run.fastest().rays.forward_photons, run.fastest());
    });
    table.add("  vertices in the backward map", [&](const TimedRun& run) {
        return per_phase(run.fastest().rays.backward_photons, run.fastest());
    });
    table.add("  deposits", [&](const TimedRun& run) {
        return per_phase(run.fastest().rays.deposits, run.fastest());
    });
    table.add("whole run",
              [](const TimedRun& run) { return fmt::format("{:.3f} s", run.fastest().wall_s); });
    table.add("cores at work", [](const TimedRun& run) {
        return fmt::format("{:.2f}", run.fastest().cpu_s / run.fastest().wall_s);
    });
    table.add("noise δ", [](const TimedRun& run) {
        const double delta = run.fastest().delta;
        return std::isfinite(delta) ? fmt::format("{:.3g} %", 100.0 * delta) : "-";
    });
    bool extrapolated = false;
    if (plan.runs.delta) {
        for (const TimedRun& run : runs) extrapolated |= !run.fastest().accuracy_reached;
        table.add(
            fmt::format("time to δ = {:.3g} %", 100.0 * *plan.runs.delta),
            [&](const TimedRun& run) { return expected_text(run.fastest(), *plan.runs.delta); });
    }
    table.add("memory of maps and images", [](const TimedRun& run) {
        const RunMeasure& m = run.fastest();
        return byte_size(
            static_cast<double>(m.forward_map_bytes + m.backward_map_bytes + m.image_bytes));
    });
    table.add("memory of the process", [](const TimedRun& run) {
        return byte_size(static_cast<double>(run.fastest().peak_memory_bytes));
    });
    if (runs.size() > 1) {
        const auto add_factor = [&](const char* name, double optics::Comparison::*factor) {
            table.add(name, [&](const TimedRun& run) {
                return factor_text(optics::compare(run, runs.front()).*factor);
            });
        };
        add_factor("speed-up", &optics::Comparison::speed_up);
        add_factor("speed-up at equal noise", &optics::Comparison::speed_up_equal_noise);
        add_factor("maps and images, relative", &optics::Comparison::map_and_image_memory);
        add_factor("process, relative", &optics::Comparison::peak_memory);
    }
    std::string text =
        fmt::format("Whole runs, fastest of {}\n", plan.runs.repetitions) + table.text();
    if (extrapolated) {
        text +=
            "  ~: not reached within the limits; extrapolated, as if noise fell with the square "
            "root of the phases\n";
    }
    return text;
}

}  // namespace

std::string benchmark_text(const SceneBenchmark& scene, const BenchmarkPlan& plan) {
    return scene.scene + "\n\n" + rates_text(scene.rates, plan.rates.repetitions) + "\n" +
           runs_text(scene.runs, plan);
}

}  // namespace lucerna::io
