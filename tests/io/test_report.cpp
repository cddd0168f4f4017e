#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "io/report.h"
#include "tests/io/example_result.h"

using namespace lucerna;
using namespace lucerna::io;
using Catch::Matchers::WithinRel;
using nlohmann::json;

TEST_CASE("The report holds what the result says", "[unit][report]") {
    const json report = json::parse(report_json(example_result(), {"room.yaml", "abc"}));
    CHECK(report["program"] == "lucerna");
    CHECK(report["version"] == LUCERNA_VERSION);
    CHECK(report["scene"] == "room.yaml");
    CHECK(report["scene_hash"] == "abc");
    CHECK(report["seed"] == 18446744073709551615ULL);
    CHECK(report["method"] == "automatic");
    CHECK(report["threads"] == 2);
    CHECK(report["phases"] == 2);
    CHECK(report["stopped_by"] == "phases");
    CHECK(report["image"]["delta"] == 0.0193);
    CHECK(report["image"]["delta_bias"] == 0.004);
    CHECK(report["image"]["mean_luminance"] == 962.5);
    CHECK(report["memory"]["backward_map_bytes"] == 35'200'000);
    CHECK(report["warnings"] == json{"a warning"});

    const json& quantity = report["quantities"].at(0);
    CHECK(quantity["name"] == "desk");
    CHECK(quantity["quantity"] == "illuminance");
    CHECK(quantity["unit"] == "lx");
    CHECK_THAT(quantity["value"].get<double>(), WithinRel(512.34, 1e-12));
    CHECK_THAT(quantity["standard_error"].get<double>(), WithinRel(0.1, 1e-6));
    // Two phases: t(0.95, 1) = tan(0.95 pi / 2) = 12.706, Student 1908.
    CHECK_THAT(quantity["expanded_uncertainty"].get<double>(), WithinRel(1.2706205, 1e-6));
    CHECK(quantity["coverage"] == 0.95);
    CHECK(quantity["phases"] == 2);
    CHECK_THAT(quantity["x"].get<double>(), WithinRel(0.3112, 1e-12));
    CHECK_THAT(quantity["x_expanded_uncertainty"].get<double>(), WithinRel(1.2706205e-3, 1e-6));
    CHECK(quantity["correlated_colour_temperature_k"] == 6500.0);
    CHECK(!quantity.contains("duv"));

    const json& derived = report["derived_quantities"].at(0);
    CHECK(derived["name"] == "desk: uniformity U0");
    CHECK(derived["unit"] == "1");
    CHECK_THAT(derived["expanded_uncertainty"].get<double>(), WithinRel(0.12706205, 1e-6));
}

TEST_CASE("The bias is taken off the reported value and stated beside it", "[unit][report]") {
    optics::Result result = example_result();
    result.quantities[0].estimate = estimate(512.0, 0.1, 2.0);
    const json quantity = json::parse(report_json(result, {}))["quantities"].at(0);
    CHECK_THAT(quantity["value"].get<double>(), WithinRel(510.0, 1e-12));
    CHECK_THAT(quantity["bias"].get<double>(), WithinRel(2.0, 1e-12));
    CHECK_THAT(quantity["uncorrected"]["value"].get<double>(), WithinRel(512.0, 1e-12));
    CHECK(quantity["bias_left"].get<double>() >= 0.0);
}

TEST_CASE("The flux balance of the report closes", "[unit][report]") {
    const json flux = json::parse(report_json(example_result(), {}))["flux_balance_lm"];
    double sum = 0.0;
    for (const auto& [material, flux_lm] : flux["absorbed"].items()) sum += flux_lm.get<double>();
    for (const char* part : {"escaped", "trapped", "inconsistent_medium", "numerical",
                             "roulette_residue", "closure"}) {
        sum += flux[part].get<double>();
    }
    CHECK_THAT(sum, WithinRel(flux["emitted"].get<double>(), 1e-12));
}

TEST_CASE("The worst image of several stands for all", "[unit][report]") {
    optics::Result result = example_result();
    result.images.push_back(result.images[0]);
    result.images[1].name = "detail";
    result.images[1].delta = 0.5;
    const json report = json::parse(report_json(result, {}));
    CHECK(report["image"]["name"] == "detail");
    CHECK(report["images"].size() == 2);
    result.images.clear();
    CHECK(json::parse(report_json(result, {}))["image"].is_null());
}

TEST_CASE("Numbers that are not finite become null with a warning that names them",
          "[unit][report]") {
    optics::Result result = example_result();
    result.quantities[0].estimate = Estimate();
    result.quantities[0].estimate.add(512.34);  // one phase: its standard error is unknown
    result.images[0].delta = std::numeric_limits<double>::quiet_NaN();
    const json report = json::parse(report_json(result, {}));
    CHECK(report["quantities"][0]["value"] == 512.34);
    CHECK(report["quantities"][0]["standard_error"].is_null());
    CHECK(report["image"]["delta"].is_null());
    REQUIRE(report["warnings"].size() == 2);
    const std::string warning = report["warnings"][1];
    CHECK_THAT(warning, Catch::Contains("desk standard_error") && Catch::Contains("view delta"));
}

TEST_CASE("Names that are not UTF-8 do not cost the report", "[unit][report]") {
    const json report = json::parse(report_json(example_result(), {"Stra\xDF"
                                                                   "e.yaml",
                                                                   ""}));
    CHECK(report["scene"] == "Stra\uFFFDe.yaml");
}
