// What is reported of sensors: luminance and illuminance, colour, and what follows from grids.
#include <fmt/format.h>

#include <algorithm>

#include "optics/transport/calibration.h"
#include "optics/transport/grid_figures.h"
#include "optics/transport/readings.h"
#include "spectral/colorimetry.h"

namespace lucerna::optics {
namespace {

const std::string& name_of(const Observer& observer) {
    return std::visit([](const auto& o) -> const std::string& { return o.name; }, observer);
}

std::string point_name(const IlluminancePoints& points, std::size_t k) {
    const auto columns = static_cast<std::size_t>(std::max(1, points.columns));
    if (points.columns > 0) return fmt::format("{}[{},{}]", points.name, k % columns, k / columns);
    return points.positions.size() > 1 ? fmt::format("{}[{}]", points.name, k) : points.name;
}

std::string bin_name(const Observer& observer, std::size_t bin) {
    const auto* points = std::get_if<IlluminancePoints>(&observer);
    return points != nullptr ? point_name(*points, bin) : name_of(observer);
}

}  // namespace

Uncertain Readings::result_of_sensor(const Calibration& calibration, std::size_t bin) const {
    const Estimate& estimate = luminance_[bin];
    Uncertain result = calibration.of([&](auto&& value) { return value(bin, 1); });
    result.bias_left = std::max({estimate.bias_left(), steps_[bin].beyond_noise(),
                                 relative_rounding * std::abs(result.value)});
    return result;
}

Furthest Readings::furthest_sensor(const SceneParts& parts, const Settings& targets) const {
    const Calibration calibration(sensors_, emission_);
    Furthest furthest;
    for (std::size_t i = 0; i < observers_.size(); ++i) {
        if (is_camera_[i]) continue;
        const Observer& observer = parts.observers[observers_[i].observer];
        const SensorTarget target = targets.target_of(name_of(observer));
        double t = 0.0;  // the same for all bins
        for (std::size_t bin = 0; bin < observers_[i].count; ++bin) {
            const Uncertain result = result_of_sensor(calibration, observers_[i].first_bin + bin);
            if (result.degrees_of_freedom < 1.0) return {bin_name(observer, bin), infinity};
            if (bin == 0) t = student_t(target_coverage, result.degrees_of_freedom);
            const double expanded =
                std::hypot(t * result.standard_error, target_coverage * result.bias_left);
            const double excess = target.excess(result.value, expanded);
            if (excess > furthest.excess) furthest = {bin_name(observer, bin), excess};
        }
    }
    return furthest;
}

std::optional<Colour> Readings::colour(const Calibration& calibration,
                                       std::size_t sensor_bin) const {
    const spectral::Xyz mean{calibration.value(sensor_bin, 0), calibration.value(sensor_bin, 1),
                             calibration.value(sensor_bin, 2)};
    if (!(mean.x > 0.0 && mean.y > 0.0 && mean.z > 0.0)) return std::nullopt;
    // What two kernels tell of the bias of X, Y and Z has been taken off.
    const auto phases = static_cast<double>(luminance_[sensor_bin].count());
    const Vec3 bias = Vec3(x_sum_[sensor_bin] / phases, luminance_[sensor_bin].mean(),
                           z_sum_[sensor_bin] / phases) -
                      Vec3(sensors_.mean(3 * sensor_bin), sensors_.mean(3 * sensor_bin + 1),
                           sensors_.mean(3 * sensor_bin + 2));
    // Part of what that changes may be left, beyond noise, of which the value has as much as its
    // correction. In spectra up to a fifth was (validate prism); of luminance, which has edges
    // where colour has none, half is taken.
    constexpr double part_left = 0.25;
    const auto with_bias_left = [](Uncertain value, double corrected) {
        const double beyond_noise =
            std::sqrt(std::max(0.0, square(corrected) - square(value.standard_error)));
        value.bias_left =
            std::max(part_left * beyond_noise, relative_rounding * std::abs(value.value));
        return value;
    };
    const auto share = [&](std::size_t part) {
        const auto of = [&](const Vec3& xyz) {
            return xyz[static_cast<Eigen::Index>(part)] / xyz.sum();
        };
        const Vec3 corrected(mean.x, mean.y, mean.z);
        return with_bias_left(calibration.of([&](auto&& value) {
            return of({value(sensor_bin, 0), value(sensor_bin, 1), value(sensor_bin, 2)});
        }),
                              of(corrected + bias) - of(corrected));
    };
    Colour colour{share(0), share(1), std::nullopt, std::nullopt};
    const auto temperature = spectral::correlated_colour_temperature(mean);
    if (!temperature) return colour;
    // Not sought for each batch of phases: its change with X, Y and Z is linear enough.
    const double step = 1e-4 * (mean.x + mean.y + mean.z);
    const auto along_x = spectral::correlated_colour_temperature({mean.x + step, mean.y, mean.z});
    const auto along_y = spectral::correlated_colour_temperature({mean.x, mean.y + step, mean.z});
    const auto along_z = spectral::correlated_colour_temperature({mean.x, mean.y, mean.z + step});
    if (!along_x || !along_y || !along_z) return colour;
    const auto linear = [&](double spectral::ColourTemperature::*part) {
        const double value = (*temperature).*part;
        const Vec3 slope = Vec3((*along_x).*part, (*along_y).*part, (*along_z).*part) / step -
                           Vec3::Constant(value / step);
        const Uncertain of_phases = calibration.of([&](auto&& xyz) {
            return value + slope.dot(Vec3(xyz(sensor_bin, 0) - mean.x, xyz(sensor_bin, 1) - mean.y,
                                          xyz(sensor_bin, 2) - mean.z));
        });
        return with_bias_left(of_phases, slope.dot(bias));
    };
    colour.cct_k = linear(&spectral::ColourTemperature::cct_k);
    colour.duv = linear(&spectral::ColourTemperature::duv);
    return colour;
}

std::vector<Quantity> Readings::quantities(const SceneParts& parts) const {
    const Calibration calibration(sensors_, emission_);
    std::vector<Quantity> quantities;
    for (std::size_t i = 0; i < observers_.size(); ++i) {
        const ObserverBins& bins = observers_[i];
        const Observer& observer = parts.observers[bins.observer];
        const auto report = [&](std::string name, const char* quantity, const char* unit,
                                std::size_t bin) {
            const std::size_t at = bins.first_bin + bin;
            quantities.push_back({std::move(name), quantity, unit, luminance_[at],
                                  colour(calibration, at), result_of_sensor(calibration, at)});
        };
        if (std::holds_alternative<IlluminancePoints>(observer)) {
            for (std::size_t k = 0; k < bins.count; ++k) {
                report(bin_name(observer, k), "illuminance", "lx", k);
            }
        } else if (const auto* meter = std::get_if<LuminanceMeter>(&observer)) {
            report(meter->name, "luminance", "cd/m2", 0);
        }
    }
    return quantities;
}

std::vector<DerivedQuantity> Readings::derived(const SceneParts& parts) const {
    const Calibration calibration(sensors_, emission_);
    std::vector<DerivedQuantity> derived;
    for (std::size_t i = 0; i < observers_.size(); ++i) {
        const ObserverBins& bins = observers_[i];
        const auto* points = std::get_if<IlluminancePoints>(&parts.observers[bins.observer]);
        if (points == nullptr || bins.count < 2) continue;
        std::vector<double> bias_left;
        for (std::size_t k = 0; k < bins.count; ++k) {
            bias_left.push_back(result_of_sensor(calibration, bins.first_bin + k).bias_left);
        }
        const GridFigures figures(calibration, bins.first_bin, std::move(bias_left));
        const auto report = [&](const char* what, const char* quantity, const char* unit,
                                const Uncertain& result) {
            derived.push_back({points->name + ": " + what, quantity, unit, result});
        };
        report("mean", "average illuminance", "lx", figures.mean());
        report("minimum", "minimum illuminance", "lx", figures.minimum());
        report("maximum", "maximum illuminance", "lx", figures.maximum());
        report("uniformity U0", "illuminance uniformity, minimum / average", "1",
               figures.minimum_to_mean());
        report("diversity Ud", "illuminance diversity, minimum / maximum", "1",
               figures.minimum_to_maximum());
    }
    return derived;
}

}  // namespace lucerna::optics
