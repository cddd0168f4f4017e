#include "io/scene_settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "io/setting_names.h"

namespace lucerna::io {
namespace {

constexpr std::uint64_t most_u32 = std::numeric_limits<std::uint32_t>::max();

std::optional<double> read_accuracy(const YamlCursor& cursor) {
    const auto accuracy = read_quantity(cursor, dimension::percent, Accept::positive);
    if (accuracy && accuracy->value > 1.0) cursor.complain("must be at most 100 %");
    return accuracy ? std::optional(accuracy->value) : std::nullopt;
}

/// A sensor's name and the unit of its readings.
struct SensorUnit {
    std::string name, unit;
};

std::vector<SensorUnit> sensor_units(const optics::SceneParts& parts) {
    std::vector<SensorUnit> units;
    for (const optics::Observer& observer : parts.observers) {
        if (const auto* points = std::get_if<optics::IlluminancePoints>(&observer))
            units.push_back({points->name, "lx"});
        if (const auto* meter = std::get_if<optics::LuminanceMeter>(&observer))
            units.push_back({meter->name, "cd/m2"});
    }
    for (const optics::FluxReceiver& receiver : parts.receivers)
        units.push_back({receiver.name, "lm"});
    return units;
}

/// What is asked of one sensor: "1 %" of the reading, or a number in its unit.
void read_sensor_target(const YamlMap::Entry& entry, const std::vector<SensorUnit>& sensors,
                        optics::Settings& settings) {
    const auto sensor = std::ranges::find(sensors, entry.key, &SensorUnit::name);
    if (sensor == sensors.end()) {
        std::vector<std::string> names;
        for (const SensorUnit& known : sensors) names.push_back(known.name);
        entry.value.complain(
            fmt::format("there is no sensor '{}'{}", entry.key, did_you_mean(entry.key, names)));
        return;
    }
    const auto text = entry.value.word();
    if (!text) return;
    optics::SensorTarget target{entry.key};
    if (text->find('%') != std::string::npos) {
        target.relative = read_accuracy(entry.value).value_or(0.0);
    } else {
        const Dimension& dimension = sensor->unit == "lx"      ? dimension::irradiance
                                     : sensor->unit == "cd/m2" ? dimension::luminance
                                                               : dimension::luminous_flux;
        const auto wanted = read_quantity(entry.value, dimension, Accept::positive);
        if (!wanted) return;
        if (wanted->base != sensor->unit) {
            entry.value.complain(fmt::format("'{}' is not in % or {}", *text, sensor->unit));
            return;
        }
        target.absolute = wanted->value;
    }
    settings.sensor_targets.push_back(target);
}

void read_sensor_accuracy(const YamlCursor& cursor, const optics::SceneParts& parts,
                          optics::Settings& settings) {
    if (!cursor.is_map()) {
        settings.sensor_accuracy = read_accuracy(cursor);
        return;
    }
    const std::vector<SensorUnit> sensors = sensor_units(parts);
    for (const YamlMap::Entry& entry : YamlMap(cursor).entries())
        read_sensor_target(entry, sensors, settings);
}

}  // namespace

optics::Settings read_settings(const YamlCursor& section, const optics::SceneParts& parts) {
    optics::Settings settings;
    if (!section) return settings;
    YamlMap map(section);
    std::vector<std::string> names;
    for (const auto& [name, method] : methods()) names.push_back(name);
    if (const auto name = map.optional("method").choice(names)) {
        settings.method = methods().at(*name);
    }
    if (const YamlCursor accuracy = map.optional("accuracy")) {
        YamlMap wanted(accuracy);
        settings.image_accuracy = read_accuracy(wanted.optional("image"));
        read_sensor_accuracy(wanted.optional("sensors"), parts, settings);
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
    if (const auto polarisation = map.optional("polarisation").choice({"on", "off"}))
        settings.polarisation = *polarisation == "on";
    map.no_other_keys();
    return settings;
}

}  // namespace lucerna::io
