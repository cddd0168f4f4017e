#include <catch2/catch.hpp>
#include <regex>

#include "io/measured_value.h"
#include "io/summary.h"
#include "tests/io/example_result.h"

using namespace lucerna;
using namespace lucerna::io;
using Catch::Contains;

TEST_CASE("A value is rounded to the place of its uncertainty", "[unit][summary]") {
    CHECK(measured_value(512.3412, 1.4142) == "512.3 ± 1.4");
    CHECK(measured_value(512.3412, 14.142) == "512 ± 14");
    CHECK(measured_value(512.3412, 141.42) == "510 ± 140");
    CHECK(measured_value(0.0123456, 0.000996) ==
          "0.0123 ± 0.0010");  // the rounding reaches the next place
    CHECK(measured_value(-2.0, 0.31) == "-2.00 ± 0.31");
    CHECK(measured_value(0.4, 25.0) == "0 ± 25");
    CHECK(measured_value(1254321.0, 31000.0) == "1.254e+06 ± 3.1e+04");
    CHECK(measured_value(1.5e-7, 2.1e-9) == "1.500e-07 ± 2.1e-09");
    CHECK(measured_value(3.25, 0.0) == "3.25");
    CHECK(measured_value(512.3412, std::numeric_limits<double>::infinity()) == "512.3 ± unknown");
}

TEST_CASE("Sizes are read at a glance", "[unit][summary]") {
    CHECK(byte_size(0.0) == "0 B");
    CHECK(byte_size(999.0) == "999 B");
    CHECK(byte_size(1500.0) == "1.5 kB");
    CHECK(byte_size(35'200'000.0) == "35 MB");
    CHECK(byte_size(999'900'000.0) == "1.0 GB");
}

TEST_CASE("The summary shows image, quantities, losses and files", "[unit][summary]") {
    const std::string text = summary(example_result(), {{"out/view.png", "white is 300 cd/m2"}});
    CHECK_THAT(text, Contains("Image view: 24 x 20 pixels, noise δ = 1.9 %, kernel bias 0.4 %, "
                              "mean 962.5 ± 1.6 cd/m2"));
    CHECK_THAT(text, Contains("512.3 ± 1.3 lx"));
    CHECK_THAT(text, Contains("x 0.3112 ± 0.0013  y 0.3322 ± 0.0013  6500 ± 13 K"));
    CHECK_THAT(text, Contains("desk: uniformity U0  0.60 ± 0.13"));
    CHECK_THAT(text, Contains("absorbed by wall"));
    CHECK_THAT(text, Contains("stopped by: phases\n"));
    CHECK_THAT(text, Contains("35 MB"));
    CHECK_THAT(text, Contains("Warning: a warning"));
    CHECK_THAT(text, Contains("out/view.png  white is 300 cd/m2"));
    CHECK_THAT(text, !Contains("not accounted for"));
}

TEST_CASE("The shares of the flux close to 100 %", "[unit][summary]") {
    optics::Result result = example_result();
    const bool gap = GENERATE(false, true);
    if (gap) result.flux_balance_lm.escaped -= 50.0;  // a balance that does not close must show it
    const std::string text = summary(result, {});
    CHECK((text.find("not accounted for") != std::string::npos) == gap);

    const std::regex share(R"((.*) lm +(-?[0-9.]+) %)");
    double sum = 0.0, emitted = 0.0;
    for (auto it = std::sregex_iterator(text.begin(), text.end(), share);
         it != std::sregex_iterator(); ++it) {
        const bool total = it->str(1).find("emitted") != std::string::npos;
        (total ? emitted : sum) += std::stod(it->str(2));
    }
    CHECK(emitted == 100.0);
    CHECK_THAT(sum, Catch::Matchers::WithinAbs(100.0, 5 * 0.0005));  // five rows of three decimals
}

TEST_CASE("The summary says that the accuracy was not reached", "[unit][summary]") {
    optics::Result result = example_result();
    result.accuracy_reached = false;
    CHECK_THAT(summary(result, {}),
               Contains("stopped by: phases, before the accuracy asked for was reached\n"));
    result.furthest = {"desk[3,1]", 2.44};
    CHECK_THAT(summary(result, {}), Contains("reached: U of desk[3,1] is 2.4 times as much\n"));
    result.furthest.excess = std::numeric_limits<double>::infinity();
    CHECK_THAT(summary(result, {}), Contains("reached: nothing is known of desk[3,1] yet\n"));
    result.furthest = {{}, 1.5};
    CHECK_THAT(summary(result, {}), Contains("reached: noise δ is 1.5 times as much\n"));
}

TEST_CASE("A long list of quantities is cut off with its count", "[unit][summary]") {
    optics::Result result = example_result();
    result.quantities.resize(1000, result.quantities[0]);
    CHECK_THAT(summary(result, {}), Contains("and 960 more"));
}
