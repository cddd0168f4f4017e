// What a benchmark measured: as tables for people and as JSON for programs.
#pragma once

#include <string>
#include <vector>

#include "optics/transport/benchmark.h"
#include "optics/transport/timed_runs.h"

namespace lucerna::io {

/// What was measured of one scene.
struct SceneBenchmark {
    std::string scene;       ///< path of the scene as the user gave it
    std::string scene_hash;  ///< see content_hash()
    std::uint64_t seed = 0;
    optics::Rates rates;
    std::vector<optics::TimedRun> runs;
};

/// How it was measured.
struct BenchmarkPlan {
    optics::RateEffort rates;
    optics::RunPlan runs;
};

/// Both tables of a scene; docs/benchmarks.md explains each row.
std::string benchmark_text(const SceneBenchmark& scene, const BenchmarkPlan& plan);

/// All repetitions of all scenes as JSON text; docs/benchmarks.md lists its keys. A number that is
/// infinite or undefined is null.
std::string benchmark_json(const std::vector<SceneBenchmark>& scenes, const BenchmarkPlan& plan);

}  // namespace lucerna::io
