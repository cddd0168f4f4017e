#include <ImfChannelList.h>
#include <ImfChromaticitiesAttribute.h>
#include <ImfFloatAttribute.h>
#include <ImfFloatVectorAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfIntAttribute.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>

#include <catch2/catch.hpp>
#include <regex>

#include "core/diagnostics.h"
#include "io/atomic_file.h"
#include "io/exr.h"
#include "tests/io/example_result.h"

using namespace lucerna;
using namespace lucerna::io;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

const Provenance provenance{7, {42}, "abc"};

// One channel as any reader of OpenEXR sees it.
std::vector<float> channel(const std::filesystem::path& path, const std::string& name) {
    Imf::InputFile file(path.c_str());
    const auto window = file.header().dataWindow();
    std::vector<float> values(static_cast<std::size_t>(window.max.x + 1) *
                              static_cast<std::size_t>(window.max.y + 1));
    REQUIRE(file.header().channels().findChannel(name) != nullptr);
    CHECK(file.header().channels()[name.c_str()].type == Imf::FLOAT);
    Imf::FrameBuffer frame;
    frame.insert(name, Imf::Slice::Make(Imf::FLOAT, values.data(), window));
    file.setFrameBuffer(frame);
    file.readPixels(window.min.y, window.max.y);
    return values;
}

template <typename Attribute>
auto attribute(const std::filesystem::path& path, const char* name) {
    return Imf::InputFile(path.c_str()).header().typedAttribute<Attribute>(name).value();
}

// Half the spacing of 32-bit floats, relative.
constexpr double float_rounding = 6e-8;

}  // namespace

TEST_CASE("An image carries luminance, error and bias with its provenance", "[unit][exr]") {
    ScratchFolder folder;
    const auto path = folder / "view.exr";
    const optics::Image image = example_image();
    write_exr(path, image, provenance);

    const auto luminance = channel(path, "luminance.Y");
    const auto error = channel(path, "luminance.standard_error");
    const auto bias = channel(path, "luminance.bias");
    const auto correction = channel(path, "luminance.correction");
    for (std::size_t i = 0; i < image.luminance.size(); ++i) {
        const double expected =
            1.0 + static_cast<double>(i % 24) + 100.0 * static_cast<double>(i / 24);
        CHECK_THAT(double{luminance[i]}, WithinRel(expected, float_rounding));
        // The spread is a difference of squares of size L^2, so its rounding is 1e-16 / 0.01^2.
        CHECK_THAT(double{error[i]}, WithinRel(0.01 * expected, 1e-6));
        CHECK(bias[i] == -0.5F);
        CHECK(correction[i] == 0.5F);
    }
    CHECK(attribute<Imf::StringAttribute>(path, "units") == "cd/m2");
    CHECK(attribute<Imf::IntAttribute>(path, "phases") == 7);
    CHECK(attribute<Imf::StringAttribute>(path, "seed") == "42");
    CHECK(attribute<Imf::StringAttribute>(path, "sceneHash") == "abc");
    CHECK(attribute<Imf::FloatAttribute>(path, "whiteLuminance") == 1.0F);
    CHECK(attribute<Imf::ChromaticitiesAttribute>(path, "chromaticities").red ==
          Imath::V2f(0.64F, 0.33F));
}

TEST_CASE("White of D65 has R = G = B = its luminance", "[unit][exr]") {
    ScratchFolder folder;
    const auto path = folder / "view.exr";
    write_exr(path, example_image(), provenance);
    const auto luminance = channel(path, "luminance.Y");
    for (const char* name : {"R", "G", "B"}) {
        const auto values = channel(path, name);
        for (std::size_t i = 0; i < values.size(); ++i) {
            CHECK_THAT(double{values[i]}, WithinRel(double{luminance[i]}, 1e-6));
        }
    }
}

TEST_CASE("RGB of the equal-energy white is that of BT.709", "[unit][exr]") {
    ScratchFolder folder;
    optics::Image image = example_image();
    for (std::size_t i = 0; i < image.luminance.size(); ++i) {
        image.x[i] = image.z[i] = static_cast<float>(image.luminance[i].value());
    }
    write_exr(folder / "view.exr", image, provenance);
    // Row sums of the XYZ to RGB matrix printed in IEC 61966-2-1: 3.2406 - 1.5372 - 0.4986, and so
    // on. It is the inverse of a matrix that was rounded to four decimals, and is rounded itself:
    // 3e-4 over three terms.
    CHECK_THAT(double{channel(folder / "view.exr", "R")[0]}, WithinAbs(1.2048, 3e-4));
    CHECK_THAT(double{channel(folder / "view.exr", "G")[0]}, WithinAbs(0.9484, 3e-4));
    CHECK_THAT(double{channel(folder / "view.exr", "B")[0]}, WithinAbs(0.9087, 3e-4));
}

TEST_CASE("Spectral images follow the layout of Fichet et al.", "[unit][exr]") {
    ScratchFolder folder;
    const auto path = folder / "view.spectral.exr";
    const optics::Image image = example_image();
    write_spectral_exr(path, image, provenance);

    // The pattern of the layout's reference reader.
    const std::regex pattern(
        R"(^((S([0-3]))|T)\.(\d*,?\d*([Ee][+-]?\d+)?)(Y|Z|E|P|T|G|M|k|h|da|d|c|m|u|n|p)?(m|Hz)$)");
    std::vector<double> centres_nm;
    const Imf::InputFile file(path.c_str());
    for (auto it = file.header().channels().begin(); it != file.header().channels().end(); ++it) {
        std::smatch match;
        const std::string name = it.name();
        if (!std::regex_match(name, match, pattern)) continue;
        CHECK(match[1] == "S0");
        CHECK(match[6].str() + match[7].str() == "nm");
        centres_nm.push_back(std::stod(match[4].str().replace(match[4].str().find(','), 1, ".")));
    }
    CHECK(centres_nm == std::vector<double>{450.0, 550.0, 650.0});

    // 100 nm of 0.001 * (1 + pixel) * (1 + bin) W/(m2 sr nm).
    CHECK_THAT(double{channel(path, "S0.450,000000nm")[0]}, WithinRel(0.1, 2 * float_rounding));
    CHECK_THAT(double{channel(path, "S0.650,000000nm")[9]}, WithinRel(3.0, 2 * float_rounding));
    CHECK(attribute<Imf::StringAttribute>(path, "spectralLayoutVersion") == "1.0");
    CHECK(attribute<Imf::StringAttribute>(path, "emissiveUnits") == "W.m^-2.sr^-1");
    CHECK(attribute<Imf::StringAttribute>(path, "spectralQuantity") == "radiance per bin");
    CHECK(attribute<Imf::FloatVectorAttribute>(path, "binEdges_nm") ==
          std::vector<float>{400, 500, 600, 700});
    CHECK(channel(path, "R").size() == image.luminance.size());
}

TEST_CASE("An image without spectra is not written as a spectral one", "[unit][exr]") {
    ScratchFolder folder;
    optics::Image image = example_image();
    image.bin_edges_nm.clear();
    CHECK_THROWS_AS(write_spectral_exr(folder / "x.exr", image, provenance), std::invalid_argument);
    CHECK(std::filesystem::is_empty(folder.path()));
}

TEST_CASE("What is written reads back, with its error", "[unit][exr]") {
    ScratchFolder folder;
    const optics::Image image = example_image();
    write_exr(folder / "view.exr", image, provenance);
    const LuminanceImage read = read_image(folder / "view.exr");
    REQUIRE(read.width == 24);
    REQUIRE(read.height == 20);
    CHECK(read.luminance[24] == 101.0);  // the start of the second row from the top
    CHECK_THAT(read.standard_error[24], WithinRel(1.01, 1e-6));
    CHECK(read.phases == 7);
    CHECK_THAT(read.mean_standard_error.value(), WithinRel(0.125, 1e-6));
    CHECK(read.tile_standard_error == std::vector<double>{0.25, 0.5, 0.75, 1.0});
}

TEST_CASE("Plain colour images read as luminance, scaled by whiteLuminance", "[unit][exr]") {
    ScratchFolder folder;
    const auto path = folder / "rgb.exr";
    const bool scaled = GENERATE(false, true);
    Imf::Header header(2, 1);
    std::vector<float> pixels = {1.0F, 0.0F, 0.0F, 0.0F, 1.0F, 2.0F};  // red; green + 2 blue
    Imf::FrameBuffer frame;
    for (int c = 0; c < 3; ++c) {
        const std::string name(1, "RGB"[c]);
        header.channels().insert(name, Imf::Channel(Imf::FLOAT));
        frame.insert(name,
                     Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(pixels.data() + c), 12, 24));
    }
    if (scaled) header.insert("whiteLuminance", Imf::FloatAttribute(100.0F));
    {
        Imf::OutputFile file(path.c_str(), header);
        file.setFrameBuffer(frame);
        file.writePixels(1);
    }
    const LuminanceImage image = read_image(path);
    const double scale = scaled ? 100.0 : 1.0;
    // BT.709-6 item 3.2: E'Y = 0.2126 R + 0.7152 G + 0.0722 B, four decimals.
    CHECK_THAT(double{image.luminance[0]}, WithinAbs(0.2126 * scale, 5e-5 * scale));
    CHECK_THAT(double{image.luminance[1]}, WithinAbs(0.8596 * scale, 15e-5 * scale));
    CHECK(image.standard_error.empty());
}

TEST_CASE("Files that are no images are refused with their name", "[unit][exr]") {
    ScratchFolder folder;
    write_file(folder / "text.exr", "not an image at all");
    CHECK_THROWS_AS(read_image(folder / "text.exr"), InputError);
    CHECK_THROWS_WITH(read_image(folder / "none.exr"), Catch::Contains("none.exr"));

    write_exr(folder / "view.exr", example_image(), provenance);
    const std::string whole = read_text(folder / "view.exr");
    const std::size_t kept = GENERATE(4, 50, 700, 3000);
    write_file(folder / "cut.exr", whole.substr(0, kept));
    CHECK_THROWS_AS(read_image(folder / "cut.exr"), InputError);
}

TEST_CASE("Undefined luminance is refused with its pixel", "[unit][exr]") {
    ScratchFolder folder;
    optics::Image image = example_image();
    image.luminance[25] = estimate(std::numeric_limits<double>::quiet_NaN(), 1.0);
    write_exr(folder / "view.exr", image, provenance);
    CHECK_THROWS_WITH(read_image(folder / "view.exr"), Catch::Contains("[1, 1]"));
}
