#include <catch2/catch.hpp>

#include "io/legend.h"

using namespace lucerna::io;

TEST_CASE("Ticks are 1, 2 and 5 times powers of ten within the range", "[unit][preview]") {
    CHECK(log_ticks(0.9, 25.0) == std::vector<double>{1, 2, 5, 10, 20});
    CHECK(log_ticks(0.01, 0.1) == std::vector<double>{0.01, 0.02, 0.05, 0.1});
    CHECK(log_ticks(1000.0, 5000.0) == std::vector<double>{1000, 2000, 5000});
}

TEST_CASE("Text is drawn in blocks and cut off at the border", "[unit][preview]") {
    Raster raster(8, 8, {0, 0, 0});
    draw_text(raster, 0, 0, U"1", 1, {255, 255, 255});
    CHECK(raster.at(2, 0)[0] == 255);  // the tip of the 1
    CHECK(raster.at(0, 0)[0] == 0);
    for (int x = 0; x < 5; ++x) CHECK(raster.at(x, 6)[0] == 255);  // its foot
    draw_text(raster, -20, 5, U"888888", 3, {255, 255, 255});
}

TEST_CASE("The legend's colours run from the lowest at the bottom to the highest at the top",
          "[unit][preview]") {
    Raster raster(legend_width(1), 200, {0, 0, 0});
    draw_legend(raster, 0, 1, 1.0, 1000.0, [](double position) {
        return Rgb8{static_cast<std::uint8_t>(position * 255.0), 1, 2};
    });
    std::vector<int> column;
    for (int y = 199; y >= 0; --y) {
        const Rgb8 colour = raster.at(6, y);
        if (colour[1] == 1 && colour[2] == 2) column.push_back(colour[0]);
    }
    CHECK(column.size() > 150);
    CHECK(std::is_sorted(column.begin(), column.end()));
    CHECK(column.front() <= 1);
    CHECK(column.back() >= 253);
}
