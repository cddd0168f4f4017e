#include "io/pfm.h"

#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <limits>

#include "core/diagnostics.h"

namespace lucerna::io {
namespace {

// Header words are separated by white space; one white character ends the header.
std::string next_word(std::istream& file) {
    constexpr std::size_t longest = 32;
    std::string word;
    for (int c = file.get(); c != EOF; c = file.get()) {
        const bool space = c == ' ' || c == '\n' || c == '\r' || c == '\t';
        if (space && !word.empty()) return word;
        if (!space) word += static_cast<char>(c);
        if (word.size() > longest) break;
    }
    return word;
}

template <typename Number>
std::optional<Number> parse(const std::string& word) {
    Number value{};
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
    return value;
}

float decode(const unsigned char* bytes, bool little_endian) {
    std::uint32_t bits = 0;
    for (int i = 0; i < 4; ++i) bits = bits << 8 | bytes[little_endian ? 3 - i : i];
    return std::bit_cast<float>(bits);
}

}  // namespace

LuminanceImage read_pfm(const std::filesystem::path& path) {
    const auto fail = [&](const std::string& message) {
        throw InputError({path.string()}, message);
    };
    std::ifstream file(path, std::ios::binary);
    const std::string magic = next_word(file);
    if (magic != "Pf" && magic != "PF") fail("is no PFM image; expected Pf or PF at its start");
    const int channels = magic == "PF" ? 3 : 1;

    const auto width = parse<int>(next_word(file));
    const auto height = parse<int>(next_word(file));
    const auto scale = parse<double>(next_word(file));
    if (!width || !height || *width < 1 || *height < 1 || long{*width} * *height > max_pixels) {
        fail(fmt::format("has no valid size; expected width and height, at most {} pixels",
                         max_pixels));
    }
    if (!scale || *scale == 0.0 || !std::isfinite(*scale)) {
        fail("has no valid scale; expected a number such as -1.0 (negative: little endian)");
    }

    const auto row_bytes = static_cast<std::size_t>(*width) * channels * 4;
    std::error_code error;
    const auto available = std::filesystem::file_size(path, error);
    if (error || available < row_bytes * static_cast<std::size_t>(*height)) {
        fail(fmt::format("is cut off; {} x {} pixels need {} bytes", *width, *height,
                         row_bytes * static_cast<std::size_t>(*height)));
    }

    LuminanceImage image;
    image.width = *width;
    image.height = *height;
    image.luminance.resize(static_cast<std::size_t>(*width) * *height);
    const Vec3 weights = channels == 3 ? luminance_of_rgb() : Vec3(1.0, 0.0, 0.0);
    std::vector<unsigned char> row(row_bytes);
    for (int y = *height - 1; y >= 0; --y) {
        if (!file.read(reinterpret_cast<char*>(row.data()),
                       static_cast<std::streamsize>(row_bytes))) {
            fail(fmt::format("is cut off in row {}", y));
        }
        for (int x = 0; x < *width; ++x) {
            double luminance = 0.0;
            for (int c = 0; c < channels; ++c) {
                luminance +=
                    weights[c] * double{decode(&row[static_cast<std::size_t>(x * channels + c) * 4],
                                               *scale < 0.0)};
            }
            luminance *= std::abs(*scale);
            if (!std::isfinite(luminance))
                fail(fmt::format("has no finite value at pixel [{}, {}]", x, y));
            image.luminance[static_cast<std::size_t>(y) * *width + x] = luminance;
        }
    }
    return image;
}

}  // namespace lucerna::io
