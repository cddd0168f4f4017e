#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "validation/cases.h"
#include "validation/report.h"

using namespace lucerna;
using namespace lucerna::validation;

namespace {

Case cheap_case() {
    std::vector<Case> cases = point_source_cases();
    return cases.front();
}

Check check(double truth, double truth_error = 0.0, double detects = 0.01) {
    return {"x", "illuminance", "lx", truth, truth_error, nullptr, detects};
}

}  // namespace

TEST_CASE("A check passes within its noise, and fails beyond it or without power", "[validation]") {
    const Reading reading{.value = 100.4, .standard_error = 0.1, .expanded_uncertainty = 0.196};
    CHECK(judge(check(100.0), reading).verdict == Verdict::pass);
    CHECK_FALSE(judge(check(100.0), reading).within_u);
    CHECK(judge(check(100.3), reading).within_u);
    CHECK_THAT(judge(check(100.0), reading).z, Catch::Matchers::WithinRel(4.0, 1e-3));
    CHECK(judge(check(99.9), reading).verdict == Verdict::wrong);
    // The same distance may be the truth's own error.
    CHECK(judge(check(99.9, 0.3), reading).verdict == Verdict::pass);
    CHECK(judge(check(100.0, 0.0, 0.001), reading).verdict == Verdict::too_weak);
    Reading none = reading;
    none.value = std::numeric_limits<double>::quiet_NaN();
    CHECK(judge(check(100.0), none).verdict == Verdict::wrong);
    // Few phases: Student's t allows more.
    Reading few = reading;
    few.degrees_of_freedom = 7.0;
    CHECK(judge(check(100.0), few).z_limit > 10.0);
    CHECK_THAT(judge(check(100.0), reading).z_limit, Catch::Matchers::WithinAbs(4.892, 1e-3));
}

TEST_CASE("A right truth passes, a wrong one fails, and the report says so", "[validation]") {
    std::vector<Case> cases{cheap_case(), cheap_case()};
    cases[1].id = "point_source/planted";
    for (Check& own : cases[1].checks) own.truth *= 1.1;
    Report report{.outcomes = run_cases(cases, {.first_seed = 1, .seeds = 1, .threads = 2}),
                  .plan = {}};
    CHECK(report.outcomes[0].passed());
    CHECK_FALSE(report.outcomes[1].passed());
    CHECK(report.failed_cases() == 1);
    CHECK_FALSE(report.passed());
    CHECK_THAT(report_text(report), Catch::Contains("FAILED point_source/planted") &&
                                        !Catch::Contains("FAILED point_source/isotropic"));
    const auto json = nlohmann::json::parse(report_json(report));
    CHECK(json["passed"] == false);
    CHECK(json["cases"].size() == 2);
    CHECK(json["cases"][0]["checks"][0]["readings"][0]["verdict"] == "pass");
    CHECK(json["cases"][1]["checks"][0]["readings"][0]["verdict"] == "wrong");
    const std::string page = report_html(report);
    CHECK_THAT(page, Catch::Contains("<svg") && Catch::Contains("WRONG"));
    CHECK(page.find(">nan") == std::string::npos);
}

TEST_CASE("Runs do not depend on the threads", "[validation]") {
    const std::vector<Case> cases{cheap_case()};
    const auto one = run_cases(cases, {.first_seed = 3, .seeds = 2, .threads = 1});
    const auto two = run_cases(cases, {.first_seed = 3, .seeds = 2, .threads = 2});
    for (std::size_t seed = 0; seed < 2; ++seed) {
        CHECK(one[0].runs[seed].checks[0].reading.value ==
              two[0].runs[seed].checks[0].reading.value);
    }
    CHECK(one[0].runs[0].checks[0].reading.value != one[0].runs[1].checks[0].reading.value);
}

TEST_CASE("Binomial intervals are those of Clopper and Pearson", "[validation]") {
    // R 4, binom.test(95, 100): 0.8871651 to 0.9835681; (0, 10): 0 to 0.3084971.
    const Share share{95, 100};
    CHECK_THAT(share.lower(), Catch::Matchers::WithinAbs(0.8871651, 1e-6));
    CHECK_THAT(share.upper(), Catch::Matchers::WithinAbs(0.9835681, 1e-6));
    CHECK(Share{0, 10}.lower() == 0.0);
    CHECK_THAT((Share{0, 10}.upper()), Catch::Matchers::WithinAbs(0.3084971, 1e-6));
    CHECK(Share{10, 10}.upper() == 1.0);
    const auto [low, high] = binomial_bounds(100, 0.95);
    CHECK(low == 90);  // R: qbinom(c(0.025, 0.975), 100, 0.95)
    CHECK(high == 99);
}
