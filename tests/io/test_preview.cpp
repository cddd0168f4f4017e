#include <png.h>

#include <catch2/catch.hpp>

#include "io/colour_map.h"
#include "io/display_encoding.h"
#include "io/preview.h"
#include "tests/io/example_result.h"

using namespace lucerna;
using namespace lucerna::io;
using Catch::Matchers::WithinAbs;

namespace {

// XYZ of a D65 grey.
std::array<float, 3> grey(double y) {
    return {static_cast<float>(y * 0.3127 / 0.3290), static_cast<float>(y),
            static_cast<float>(y * 0.3583 / 0.3290)};
}

// The transfer function of IEC 61966-2-1, section 5.2.
double srgb(double linear) {
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
}

}  // namespace

TEST_CASE("Greys are encoded by the sRGB curve", "[unit][preview]") {
    for (const double y : {0.0, 0.001, 0.02, 0.18, 0.5, 0.8, 1.0}) {
        const Rgb8 pixel = encode_for_display({grey(y)})[0];
        for (const auto level : pixel) CHECK_THAT(1.0 * level, WithinAbs(255.0 * srgb(y), 0.6));
    }
}

TEST_CASE("Primaries come out pure, and what no display has is clipped", "[unit][preview]") {
    // Columns of the RGB to XYZ matrix printed in IEC 61966-2-1.
    const auto pixels = encode_for_display({{0.4124F, 0.2126F, 0.0193F},
                                            {0.3576F, 0.7152F, 0.1192F},
                                            {0.1805F, 0.0722F, 0.9505F},
                                            {100.0F, 100.0F, 100.0F},
                                            {-1.0F, -1.0F, -1.0F},
                                            {NAN, NAN, NAN}});
    const std::vector<Rgb8> expected = {{255, 0, 0},     {0, 255, 0}, {0, 0, 255},
                                        {255, 255, 255}, {0, 0, 0},   {0, 0, 0}};
    for (std::size_t i = 0; i < expected.size(); ++i) {
        for (std::size_t c = 0; c < 3; ++c) {
            CAPTURE(i, c);
            CHECK(std::abs(int{pixels[i][c]} - int{expected[i][c]}) <=
                  1);  // the matrix has four decimals
        }
    }
}

TEST_CASE("The 95th percentile of luminance is shown at 80 % of white", "[unit][preview]") {
    optics::Image image = example_image();
    for (std::size_t i = 0; i < image.luminance.size(); ++i) {
        // 5 % of the pixels that are lit have 1000 cd/m2, the others 100 cd/m2; a tenth is black.
        const double luminance = i % 10 == 0 ? 0.0 : i > 458 ? 1000.0 : 100.0;
        image.luminance[i] = estimate(luminance, 0.0);
        image.x[i] = grey(luminance)[0];
        image.z[i] = grey(luminance)[2];
    }
    NaturalPreview preview = natural_preview(image);
    CHECK_THAT(preview.white_luminance, WithinAbs(125.0, 1e-9));
    CHECK_THAT(1.0 * preview.raster.at(1, 0)[1], WithinAbs(255.0 * srgb(0.8), 0.6));
    CHECK(preview.raster.at(0, 0) == Rgb8{0, 0, 0});
    CHECK(preview.raster.at(23, 19) == Rgb8{255, 255, 255});
}

TEST_CASE("The false colours rise in lightness and lie within sRGB", "[unit][preview]") {
    // Linear sRGB by the matrix printed in IEC 61966-2-1; CIE 1976 lightness L* = 116 (Y)^(1/3) -
    // 16 (Y > 0.0089).
    double last_lightness = 0.0;
    std::vector<double> steps;
    for (int i = 0; i <= 200; ++i) {
        const Vec3 c = false_colour_xyz(i / 200.0);
        const Vec3 rgb(3.2406 * c.x() - 1.5372 * c.y() - 0.4986 * c.z(),
                       -0.9689 * c.x() + 1.8758 * c.y() + 0.0415 * c.z(),
                       0.0557 * c.x() - 0.2040 * c.y() + 1.0570 * c.z());
        CHECK(rgb.minCoeff() > -1e-3);
        CHECK(rgb.maxCoeff() < 1.0 + 1e-3);
        const double lightness =
            c.y() > 216.0 / 24389.0 ? 116.0 * std::cbrt(c.y()) - 16.0 : 24389.0 / 27.0 * c.y();
        if (i > 0) steps.push_back(lightness - last_lightness);
        last_lightness = lightness;
    }
    const auto [smallest, largest] = std::minmax_element(steps.begin(), steps.end());
    CHECK(*smallest > 0.0);
    CHECK(*largest < 2.5 * *smallest);  // no flat stretch and no jump that would look like an edge
}

TEST_CASE("A false-colour image spans its luminances and has a legend", "[unit][preview]") {
    optics::Image image =
        example_image();  // 1 to 1924 cd/m2, a percentile is 5 pixels: from 5 to 1919
    FalseColourPreview preview = false_colour_preview(image);
    CHECK(preview.max_luminance == 2000.0);
    CHECK(preview.min_luminance == 5.0);
    CHECK(preview.raster.width > image.width);
    CHECK(preview.raster.height >= 120);  // room for the legend
    // Brighter pixels are lighter: compare G, which rises along the map.
    CHECK(preview.raster.at(0, 19)[1] > preview.raster.at(0, 2)[1]);

    for (auto& luminance : image.luminance) luminance = Estimate();
    CHECK(false_colour_preview(image).max_luminance == 1.0);  // without any light: still a picture
    CHECK(natural_preview(image).raster.at(0, 0).size() == 3);
}

TEST_CASE("A PNG reads back with the same pixels", "[unit][preview]") {
    ScratchFolder folder;
    Raster raster(5, 3, {1, 2, 3});
    raster.at(4, 0) = {250, 128, 7};
    write_png(folder / "a.png", raster);

    png_image read{};
    read.version = PNG_IMAGE_VERSION;
    REQUIRE(png_image_begin_read_from_file(&read, (folder / "a.png").c_str()));
    read.format = PNG_FORMAT_RGB;
    std::vector<Rgb8> pixels(PNG_IMAGE_SIZE(read) / 3);
    REQUIRE(png_image_finish_read(&read, nullptr, pixels.data(), 0, nullptr));
    CHECK(read.width == 5);
    CHECK(pixels == raster.pixels);
}
