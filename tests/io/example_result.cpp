#include "tests/io/example_result.h"

#include <fstream>
#include <iterator>

namespace lucerna::io {

Estimate estimate(double mean, double standard_error, double bias) {
    Estimate result;
    result.add(mean - standard_error, bias);
    result.add(mean + standard_error, bias);
    return result;
}

optics::Image example_image() {
    optics::Image image;
    image.name = "view";
    image.width = 24;
    image.height = 20;
    image.bin_edges_nm = {400.0, 500.0, 600.0, 700.0};
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            const double luminance = 1.0 + x + 100.0 * y;
            image.luminance.push_back(estimate(luminance - 0.5, 0.01 * luminance, -0.5));
            image.x.push_back(static_cast<float>(luminance * 0.3127 / 0.3290));
            image.z.push_back(static_cast<float>(luminance * (1.0 - 0.3127 - 0.3290) / 0.3290));
            const int pixel = y * image.width + x;
            for (int bin = 0; bin < 3; ++bin) {
                image.spectral_radiance.push_back(0.001F *
                                                  static_cast<float>((1 + pixel) * (1 + bin)));
            }
        }
    }
    for (const double mean : {1.0, 2.0, 3.0, 4.0})
        image.tiles.push_back(estimate(mean, 0.25 * mean));
    image.mean = estimate(962.5, 0.125);
    image.delta = 0.0193;
    image.delta_bias = 0.004;
    return image;
}

optics::Result example_result() {
    optics::Result result;
    result.images = {example_image()};
    result.quantities = {{"desk", "illuminance", "lx", estimate(512.34, 0.1),
                          optics::Colour{.x = {0.3112, 0.0001, 1.0},
                                         .y = {0.3322, 0.0001, 1.0},
                                         .cct_k = Uncertain{6500.0, 1.0, 1.0},
                                         .duv = std::nullopt}}};
    result.derived = {{"desk: uniformity U0", "illuminance uniformity, minimum / average", "1",
                       Uncertain{0.6, 0.01, 1.0}}};
    result.flux_balance_lm.emitted = 1000.0;
    result.flux_balance_lm.absorbed = {{"floor", 333.3}, {"wall", 555.5}};
    result.flux_balance_lm.escaped = 111.1;
    result.flux_balance_lm.roulette_residue = 0.1;
    result.settings.seed = 18446744073709551615ULL;  // does not fit a double
    result.seeds = {result.settings.seed};
    result.settings.threads = 2;
    result.phases = 2;
    result.wall_s = 1.5;
    result.stopped_by = "phases";
    result.backward_map_bytes = 35'200'000;
    result.warnings = {"a warning"};
    return result;
}

std::string read_text(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace lucerna::io
