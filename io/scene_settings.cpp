#include "io/scene_settings.h"

#include <limits>
#include <map>

namespace lucerna::io {
namespace {

constexpr std::uint64_t most_u32 = std::numeric_limits<std::uint32_t>::max();

std::optional<double> read_accuracy(const YamlCursor& cursor) {
    const auto accuracy = read_quantity(cursor, dimension::percent, Accept::positive);
    if (accuracy && accuracy->value > 1.0) cursor.complain("must be at most 100 %");
    return accuracy ? std::optional(accuracy->value) : std::nullopt;
}

}  // namespace

optics::Settings read_settings(const YamlCursor& section) {
    optics::Settings settings;
    if (!section) return settings;
    YamlMap map(section);
    if (const auto method =
            map.optional("method").choice({"combined", "forward", "backward", "path"})) {
        const std::map<std::string, optics::Method> methods{{"combined", optics::Method::combined},
                                                            {"forward", optics::Method::forward},
                                                            {"backward", optics::Method::backward},
                                                            {"path", optics::Method::path}};
        settings.method = methods.at(*method);
    }
    if (const YamlCursor accuracy = map.optional("accuracy")) {
        YamlMap wanted(accuracy);
        settings.image_accuracy = read_accuracy(wanted.optional("image"));
        settings.sensor_accuracy = read_accuracy(wanted.optional("sensors"));
        wanted.no_other_keys();
    }
    if (const auto limit =
            read_quantity(map.optional("time_limit"), dimension::time, Accept::positive))
        settings.time_limit_s = limit->value;
    if (const YamlCursor phases = map.optional("phases"))
        settings.max_phases = static_cast<std::uint32_t>(read_count(phases, 1, most_u32));
    if (const YamlCursor seed = map.optional("seed"))
        settings.seed = read_count(seed, 0, std::numeric_limits<std::uint64_t>::max());
    if (const YamlCursor rays = map.optional("forward_rays"))
        settings.forward_rays = static_cast<std::uint32_t>(read_count(rays, 1, most_u32));
    if (const YamlCursor samples = map.optional("samples_per_pixel"))
        settings.samples_per_pixel = static_cast<int>(read_count(samples, 1, 1u << 16));
    if (const YamlCursor bins = map.optional("spectral_bins"))
        settings.spectral_bins = static_cast<int>(read_count(bins, 0, 470));
    map.no_other_keys();
    return settings;
}

}  // namespace lucerna::io
