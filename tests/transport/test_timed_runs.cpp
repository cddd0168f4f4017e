// The arithmetic of comparing runs, on measures made by hand.
#include <catch2/catch.hpp>

#include "optics/transport/timed_runs.h"

using namespace lucerna::optics;

namespace {

// Ten phases of `phase_s` each after 1 s of setup and 2 s of pilot phases.
RunMeasure measure(double phase_s, double delta, std::uint64_t bytes) {
    RunMeasure m;
    m.phases = 10;
    m.wall_s = 3.0 + 10.0 * phase_s;
    m.rays.setup_s = 1.0;
    m.rays.pilot_s = 2.0;
    m.rays.backward_s = 5.0 * phase_s;
    m.rays.readings_s = 4.0 * phase_s;
    m.delta = delta;
    m.image_bytes = m.peak_memory_bytes = bytes;
    return m;
}

}  // namespace

TEST_CASE("The time of a phase leaves out what is done once", "[timed_runs]") {
    const RunMeasure m = measure(0.5, 0.1, 100);
    CHECK(m.phase_s() == Approx(0.5));
    CHECK(m.rest_s() == Approx(0.5));  // 1/10 of the phases
    CHECK(m.expected_s(0.1) == Approx(8.0));
    CHECK(m.expected_s(0.05) == Approx(3.0 + 40.0 * 0.5));  // four times the phases
}

TEST_CASE("Runs are compared by the medians of pairs", "[timed_runs]") {
    // All of the second repetition met a disturbance that made it ten times slower.
    const TimedRun first{Method::combined,
                         Scheduler::ordered,
                         1,
                         {measure(1.0, 0.1, 100), measure(10.0, 0.1, 100), measure(1.0, 0.1, 100)}};
    const TimedRun other{Method::forward,
                         Scheduler::ordered,
                         1,
                         {measure(0.5, 0.2, 300), measure(5.0, 0.2, 300), measure(0.9, 0.2, 300)}};
    const Comparison comparison = compare(other, first);
    CHECK(comparison.speed_up == Approx(2.0));
    CHECK(comparison.speed_up_equal_noise == Approx(0.5));  // twice the noise: 4 times the phases
    CHECK(comparison.map_and_image_memory == Approx(3.0));
    CHECK(comparison.peak_memory == Approx(3.0));
    CHECK(other.fastest().phase_s() == Approx(0.5));
    CHECK(compare(first, first).speed_up == 1.0);
}

TEST_CASE("Noise that is not known compares to nothing", "[timed_runs]") {
    const TimedRun run{Method::combined, Scheduler::ordered, 1, {measure(1.0, std::nan(""), 100)}};
    CHECK(compare(run, run).speed_up == 1.0);
    CHECK(std::isnan(compare(run, run).speed_up_equal_noise));
}
