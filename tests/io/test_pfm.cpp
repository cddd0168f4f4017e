#include <bit>
#include <catch2/catch.hpp>
#include <cstdint>

#include "core/diagnostics.h"
#include "io/atomic_file.h"
#include "io/luminance_image.h"
#include "tests/io/example_result.h"

using namespace lucerna;
using namespace lucerna::io;
using Catch::Matchers::WithinAbs;

namespace {

std::string floats(const std::vector<float>& values, bool little_endian) {
    std::string bytes;
    for (const float value : values) {
        const auto bits = std::bit_cast<std::uint32_t>(value);
        for (int i = 0; i < 4; ++i)
            bytes += static_cast<char>(bits >> 8 * (little_endian ? i : 3 - i));
    }
    return bytes;
}

}  // namespace

TEST_CASE("PFM rows run upwards, in either byte order, times the scale", "[unit][pfm]") {
    ScratchFolder folder;
    const bool little = GENERATE(true, false);
    write_file(folder / "a.pfm", (little ? "Pf\n2 3\n-2.0\n" : "Pf\n2 3\n2.0\n") +
                                     floats({1, 2, 3, 4, 5, 6}, little));
    const LuminanceImage image = read_image(folder / "a.pfm");
    CHECK(image.width == 2);
    CHECK(image.height == 3);
    CHECK(image.luminance == std::vector<double>{10, 12, 6, 8, 2, 4});
    CHECK(image.standard_error.empty());
}

TEST_CASE("Colour PFM is weighted to luminance", "[unit][pfm]") {
    ScratchFolder folder;
    write_file(folder / "a.pfm", "PF 1 1 -1\n" + floats({1, 10, 100}, true));
    // BT.709-6 item 3.2 to four decimals: 0.2126 + 7.152 + 7.22
    CHECK_THAT(read_image(folder / "a.pfm").luminance[0], WithinAbs(14.5846, 0.006));
}

TEST_CASE("Damaged PFM files are refused", "[unit][pfm]") {
    ScratchFolder folder;
    const std::string one = floats({1}, true);
    const std::string bytes = GENERATE_COPY(values<std::string>(
        {"Pf\n2 2\n-1\n" + one, "Pf\n0 1\n-1\n", "Pf\n-1 -1\n-1\n" + one, "Pf\n1 1\n0\n" + one,
         "Pf\n1 1\nnan\n" + one, "Pf\n1.5 1\n-1\n" + one, "Pf\n99999999 99999999\n-1\n" + one,
         "Pf\n1 1\n-1\n" + floats({std::numeric_limits<float>::infinity()}, true), "Pf\n",
         "P6\n1 1\n255\nabc", "Pf" + std::string(100, '1')}));
    write_file(folder / "bad.pfm", bytes);
    CHECK_THROWS_AS(read_image(folder / "bad.pfm"), InputError);
}
