#include <nlohmann/json.hpp>

#include "core/parallel.h"
#include "io/benchmark_report.h"
#include "io/setting_names.h"

namespace lucerna::io {
namespace {

using BenchmarkJson = nlohmann::ordered_json;  // writes numbers that are not finite as null

BenchmarkJson rate_json(const optics::Rate& rate) {
    return {{"items", rate.items}, {"per_s", rate.per_s}};
}

BenchmarkJson trace_json(const optics::TraceRates& trace) {
    BenchmarkJson fractions = BenchmarkJson::array();
    for (std::size_t i = 0; i < trace.traced.per_s.size(); ++i) {
        fractions.push_back(trace.fraction(i));
    }
    return {{"bare", rate_json(trace.bare)},
            {"traced", rate_json(trace.traced)},
            {"fraction", fractions}};
}

BenchmarkJson forward_map_json(const optics::ForwardMapRates& map) {
    return {{"build", rate_json(map.build)}, {"gather", rate_json(map.gather)}};
}

BenchmarkJson rates_json(const optics::Rates& rates) {
    return {{"threads", rates.threads},
            {"forward_rays", trace_json(rates.forward)},
            {"backward_rays", trace_json(rates.backward)},
            {"backward_map",
             {{"build", rate_json(rates.backward_map.build)},
              {"find", rate_json(rates.backward_map.find)},
              {"deposit", rate_json(rates.backward_map.deposit)}}},
            {"caustic_map", forward_map_json(rates.caustic_map)},
            {"indirect_map", forward_map_json(rates.indirect_map)}};
}

BenchmarkJson measure_json(const optics::RunMeasure& m, const std::optional<double>& delta) {
    BenchmarkJson json = {{"wall_s", m.wall_s},
                          {"cpu_s", m.cpu_s},
                          {"phases", m.phases},
                          {"phase_s", m.phase_s()},
                          {"stages_s",
                           {{"setup", m.rays.setup_s},
                            {"pilot", m.rays.pilot_s},
                            {"forward_traces_for_maps", m.rays.caustic_s},
                            {"maps", m.rays.maps_s},
                            {"backward_trace", m.rays.backward_s},
                            {"secondary_trace_and_deposits", m.rays.secondary_s},
                            {"images", m.rays.readings_s},
                            {"rest", m.rest_s()}}},
                          {"forward_photons", m.rays.forward_photons},
                          {"backward_photons", m.rays.backward_photons},
                          {"deposits", m.rays.deposits},
                          {"delta", m.delta},
                          {"stopped_by", m.stopped_by},
                          {"forward_map_bytes", m.forward_map_bytes},
                          {"backward_map_bytes", m.backward_map_bytes},
                          {"image_bytes", m.image_bytes},
                          {"peak_memory_bytes", m.peak_memory_bytes}};
    if (delta) {
        json["delta_reached"] = m.accuracy_reached;
        json[m.accuracy_reached ? "time_to_delta_s" : "extrapolated_time_to_delta_s"] =
            m.accuracy_reached ? m.wall_s : m.expected_s(*delta);
    }
    return json;
}

BenchmarkJson run_json(const optics::TimedRun& run, const optics::TimedRun& first,
                       const std::optional<double>& delta) {
    const optics::Comparison comparison = optics::compare(run, first);
    BenchmarkJson json = {{"method", name_of(run.method)},
                          {"scheduler", name_of(run.scheduler)},
                          {"threads", run.threads},
                          {"relative_to_first",
                           {{"speed_up", comparison.speed_up},
                            {"speed_up_at_equal_noise", comparison.speed_up_equal_noise},
                            {"map_and_image_bytes", comparison.map_and_image_memory},
                            {"peak_memory_bytes", comparison.peak_memory}}}};
    json["repetitions"] = BenchmarkJson::array();
    for (const optics::RunMeasure& measure : run.repetitions) {
        json["repetitions"].push_back(measure_json(measure, delta));
    }
    return json;
}

template <typename Value>
BenchmarkJson or_null(const std::optional<Value>& value) {
    return value ? BenchmarkJson(*value) : BenchmarkJson(nullptr);
}

}  // namespace

std::string benchmark_json(const std::vector<SceneBenchmark>& scenes, const BenchmarkPlan& plan) {
    BenchmarkJson json = {{"program", "lucerna"},
                          {"version", LUCERNA_VERSION},
                          {"hardware_threads", hardware_threads()},
                          {"plan",
                           {{"paths", plan.rates.paths},
                            {"repetitions", plan.runs.repetitions},
                            {"phases", or_null(plan.runs.phases)},
                            {"delta", or_null(plan.runs.delta)},
                            {"time_limit_s", or_null(plan.runs.time_limit_s)}}}};
    json["scenes"] = BenchmarkJson::array();
    for (const SceneBenchmark& scene : scenes) {
        BenchmarkJson of_scene = {{"scene", scene.scene},
                                  {"scene_hash", scene.scene_hash},
                                  {"seed", scene.seed},
                                  {"rates", rates_json(scene.rates)}};
        of_scene["runs"] = BenchmarkJson::array();
        for (const optics::TimedRun& run : scene.runs) {
            of_scene["runs"].push_back(run_json(run, scene.runs.front(), plan.runs.delta));
        }
        json["scenes"].push_back(of_scene);
    }
    // Text that is not UTF-8 (a file name can be anything) must not cost the numbers.
    return json.dump(2, ' ', false, BenchmarkJson::error_handler_t::replace) + "\n";
}

}  // namespace lucerna::io
