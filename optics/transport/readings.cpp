#include "optics/transport/readings.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "core/parallel.h"
#include "spectral/colorimetry.h"

namespace lucerna::optics {

Uncertain Image::pixel(std::size_t i) const {
    const Estimate& estimate = luminance[i];
    // The square of a measured bias holds that of its noise.
    const double bias =
        std::max(0.0, std::pow(estimate.bias(), 2) - std::pow(estimate.bias_standard_error(), 2));
    const double left = 1.0 - correction;
    const double noise = estimate.standard_error(correction);
    return {estimate.value(correction), std::sqrt(noise * noise + left * left * bias),
            estimate.degrees_of_freedom()};
}

namespace {

// Points whose value is as near to the least one as this many standard errors of the difference
// might be the least in truth.
constexpr double rival_errors = 2.0;

std::size_t tiles_along(std::size_t pixels) {
    constexpr std::size_t size = Image::tile_size;
    return (pixels + size - 1) / size;
}

const std::string& name_of(const Observer& observer) {
    return std::visit([](const auto& o) -> const std::string& { return o.name; }, observer);
}

std::string point_name(const IlluminancePoints& points, std::size_t k) {
    const auto columns = static_cast<std::size_t>(std::max(1, points.columns));
    if (points.columns > 0) return fmt::format("{}[{},{}]", points.name, k % columns, k / columns);
    return points.positions.size() > 1 ? fmt::format("{}[{}]", points.name, k) : points.name;
}

std::size_t bins_of(const Observer& observer) {
    if (const auto* camera = std::get_if<Camera>(&observer)) {
        return static_cast<std::size_t>(camera->width) * static_cast<std::size_t>(camera->height);
    }
    if (const auto* points = std::get_if<IlluminancePoints>(&observer)) {
        return points->positions.size();
    }
    return 1;
}

}  // namespace

PhaseReadings::PhaseReadings(std::size_t bins, std::size_t sensor_bins, std::size_t spectral_bins)
    : values_(bins),
      steps_(sensor_bins),
      spectral_bins_(spectral_bins),
      spectral_(bins * spectral_bins) {}

void PhaseReadings::add(const Phase& phase, std::size_t bin, const Lanes& radiance) {
    Value& value = values_[bin];
    value.x += static_cast<double>((radiance * phase.wavelengths.x).sum());
    value.y += static_cast<double>((radiance * phase.wavelengths.luminance).sum());
    value.z += static_cast<double>((radiance * phase.wavelengths.z).sum());
    if (spectral_bins_ == 0) return;
    constexpr double range_nm = spectral::max_wavelength_nm - spectral::min_wavelength_nm;
    for (int lane = 0; lane < spectral::lane_count; ++lane) {
        const double nm = phase.wavelengths.wavelength_nm[static_cast<std::size_t>(lane)];
        const double place = (nm - spectral::min_wavelength_nm) / range_nm;
        const auto spectral_bin =
            std::min(spectral_bins_ - 1,
                     static_cast<std::size_t>(place * static_cast<double>(spectral_bins_)));
        spectral_[bin * spectral_bins_ + spectral_bin] +=
            static_cast<double>(radiance[lane] * phase.wavelengths.interval_nm[lane]);
    }
}

void PhaseReadings::add(const Phase& phase, std::size_t bin, const Lanes& radiance,
                        const Lanes& bias) {
    add(phase, bin, radiance);
    Value& value = values_[bin];
    value.x_bias += static_cast<double>((bias * phase.wavelengths.x).sum());
    value.y_bias += static_cast<double>((bias * phase.wavelengths.luminance).sum());
    value.z_bias += static_cast<double>((bias * phase.wavelengths.z).sum());
}

void PhaseReadings::add_tristimulus(std::size_t bin, const Lanes& xyz, const Lanes& bias) {
    Value& value = values_[bin];
    value.x += static_cast<double>(xyz[0]);
    value.y += static_cast<double>(xyz[1]);
    value.z += static_cast<double>(xyz[2]);
    value.x_bias += static_cast<double>(bias[0]);
    value.y_bias += static_cast<double>(bias[1]);
    value.z_bias += static_cast<double>(bias[2]);
}

Readings::Readings(const SceneParts& parts, const Settings& settings)
    : spectral_bins_(static_cast<std::size_t>(settings.spectral_bins)) {
    for (std::size_t i = 0; i < parts.observers.size(); ++i) {
        const bool camera = std::holds_alternative<Camera>(parts.observers[i]);
        const std::size_t count = bins_of(parts.observers[i]);
        if (count == 0) continue;
        observers_.push_back({i, 0, count});
        is_camera_.push_back(camera);
        means_.emplace_back();
        if (camera) {
            const Camera& view = std::get<Camera>(parts.observers[i]);
            ImageMeans& means = means_.back();
            means.width = static_cast<std::size_t>(view.width);
            means.height = static_cast<std::size_t>(view.height);
            means.tiles.resize(tiles_along(means.width) * tiles_along(means.height));
        }
    }
    std::size_t bins = 0;
    for (const bool cameras : {false, true}) {
        for (std::size_t i = 0; i < observers_.size(); ++i) {
            if (is_camera_[i] != cameras) continue;
            observers_[i].first_bin = bins;
            bins += observers_[i].count;
        }
        if (!cameras) steps_.resize(bins);
    }
    sensors_ = BatchMeans(3 * steps_.size() + 3);
    for (const Light& light : parts.lights) {
        const spectral::Xyz xyz = spectral::tristimulus(parts.spectra[light.flux_w_per_nm]);
        emission_ += Vec3(xyz.x, xyz.y, xyz.z);
    }
    luminance_.resize(bins);
    x_sum_.resize(bins);
    z_sum_.resize(bins);
    spectral_sum_.resize(bins * spectral_bins_);
}

void Readings::fold_means(const PhaseReadings& values, const ObserverBins& bins,
                          ImageMeans& means) {
    const std::size_t columns = tiles_along(means.width);
    std::vector<double> sums(means.tiles.size());
    std::vector<double> biases(means.tiles.size());
    std::vector<double> pixels(means.tiles.size());
    for (std::size_t row = 0; row < means.height; ++row) {
        for (std::size_t column = 0; column < means.width; ++column) {
            const PhaseReadings::Value& value =
                values.values_[bins.first_bin + row * means.width + column];
            const std::size_t tile = row / Image::tile_size * columns + column / Image::tile_size;
            sums[tile] += value.y;
            biases[tile] += value.y_bias;
            pixels[tile] += 1.0;
        }
    }
    double sum = 0.0;
    double bias = 0.0;
    for (std::size_t tile = 0; tile < means.tiles.size(); ++tile) {
        means.tiles[tile].add(sums[tile] / pixels[tile], biases[tile] / pixels[tile]);
        sum += sums[tile];
        bias += biases[tile];
    }
    const auto count = static_cast<double>(bins.count);
    means.whole.add(sum / count, bias / count);
}

void Readings::fold(const Phase& phase, PhaseReadings& values, int threads) {
    for_each_block(observers_.size(), threads, [&](std::size_t i) {
        if (is_camera_[i]) fold_means(values, observers_[i], means_[i]);
    });
    fold_sensors(phase, values);
    constexpr std::size_t block = 1 << 14;
    for_each_block((luminance_.size() + block - 1) / block, threads, [&](std::size_t b) {
        const std::size_t end = std::min(luminance_.size(), (b + 1) * block);
        for (std::size_t bin = b * block; bin < end; ++bin) {
            PhaseReadings::Value& value = values.values_[bin];
            luminance_[bin].add(value.y, value.y_bias);
            x_sum_[bin] += value.x;
            z_sum_[bin] += value.z;
            value = {};
        }
        for (std::size_t i = b * block * spectral_bins_; i < end * spectral_bins_; ++i) {
            spectral_sum_[i] += values.spectral_[i];
            values.spectral_[i] = 0.0;
        }
    });
}

void Readings::merge(const Readings& other) {
    for (std::size_t i = 0; i < means_.size(); ++i) {
        for (std::size_t tile = 0; tile < means_[i].tiles.size(); ++tile) {
            means_[i].tiles[tile].merge(other.means_[i].tiles[tile]);
        }
        means_[i].whole.merge(other.means_[i].whole);
    }
    for (std::size_t bin = 0; bin < luminance_.size(); ++bin) {
        luminance_[bin].merge(other.luminance_[bin]);
        x_sum_[bin] += other.x_sum_[bin];
        z_sum_[bin] += other.z_sum_[bin];
    }
    for (std::size_t i = 0; i < spectral_sum_.size(); ++i) {
        spectral_sum_[i] += other.spectral_sum_[i];
    }
    sensors_.merge(other.sensors_);
    for (std::size_t bin = 0; bin < steps_.size(); ++bin) {
        steps_[bin].merge(other.steps_[bin]);
    }
}

void Readings::fold_sensors(const Phase& phase, PhaseReadings& readings) {
    std::vector<double> values;
    values.reserve(3 * steps_.size() + 3);
    for (std::size_t bin = 0; bin < steps_.size(); ++bin) {
        const PhaseReadings::Value& value = readings.values_[bin];
        values.insert(values.end(),
                      {value.x - value.x_bias, value.y - value.y_bias, value.z - value.z_bias});
        steps_[bin].add(readings.steps_[bin].slope, readings.steps_[bin].step);
        readings.steps_[bin] = {};
    }
    Lanes emission = Lanes::Zero();
    for (const Light& light : phase.stage.parts().lights) {
        emission += phase.spectra[light.flux_w_per_nm];
    }
    for (const Lanes& weights :
         {phase.wavelengths.x, phase.wavelengths.luminance, phase.wavelengths.z}) {
        values.push_back(static_cast<double>((emission * weights).sum()));
    }
    sensors_.add(values);
}

Readings::ImageError Readings::image_error(const ObserverBins& bins) const {
    double noise = 0.0;      // of the pixels as estimated
    double corrected = 0.0;  // with the whole bias taken off
    double correction_noise = 0.0;
    double bias = 0.0;
    ImageError error;
    for (std::size_t bin = bins.first_bin; bin < bins.first_bin + bins.count; ++bin) {
        const Estimate& pixel = luminance_[bin];
        noise += std::pow(pixel.mean_standard_error(), 2);
        corrected += std::pow(pixel.standard_error(), 2);
        correction_noise += std::pow(pixel.bias_standard_error(), 2);
        bias += pixel.bias() * pixel.bias();
    }
    bias = std::max(0.0, bias - correction_noise);  // its own noise would else pass for bias
    // The error of v - c b is Var v - 2 c Cov(v, b) + c^2 Var b + (1 - c)^2 bias^2; least at
    // With a single phase nothing is known of either, and all of the bias is taken off.
    const bool known = std::isfinite(noise);
    const double covariance = known ? 0.5 * (noise + correction_noise - corrected) : 0.0;
    if (known && bias + correction_noise > 0.0) {
        error.correction = std::clamp((bias + covariance) / (bias + correction_noise), 0.0, 1.0);
    }
    const double c = error.correction;
    error.noise = noise - 2.0 * c * covariance + c * c * correction_noise;
    error.bias = (1.0 - c) * (1.0 - c) * bias;
    for (std::size_t bin = bins.first_bin; bin < bins.first_bin + bins.count; ++bin) {
        error.square += std::pow(luminance_[bin].value(c), 2);
    }
    return error;
}

double Readings::image_variance() const {
    double sum = 0.0;
    for (std::size_t i = 0; i < observers_.size(); ++i) {
        if (!is_camera_[i]) continue;
        const ObserverBins& bins = observers_[i];
        for (std::size_t bin = bins.first_bin; bin < bins.first_bin + bins.count; ++bin) {
            const Estimate& pixel = luminance_[bin];
            sum += std::pow(pixel.mean_standard_error(), 2) * static_cast<double>(pixel.count());
        }
    }
    return sum;
}

double Readings::delta() const {
    double variance = 0.0;
    double square = 0.0;
    for (std::size_t i = 0; i < observers_.size(); ++i) {
        if (!is_camera_[i]) continue;
        const ImageError error = image_error(observers_[i]);
        variance += error.noise;
        square += error.square;
    }
    return square > 0.0 ? std::sqrt(variance / square) : 0.0;
}

// The wavelengths of a phase bring more or less of the emission than there is, which is known: by
// 0.5 % of its luminance, and much more of its colour. Readings follow that as far as their light
// comes straight or is scattered, wholly in grey scenes; light behind dispersive glass has
// wavelengths of its own. By how much is a regression over batches of phases, so that what is
// reported is a ratio estimator where that is of use. It is biased by O(1 / phases) of the phases'
// variance.
class Readings::Calibration {
public:
    explicit Calibration(const Readings& readings)
        : sums_(readings.sensors_),
          emission_(readings.emission_),
          first_of_emission_(3 * readings.steps_.size()) {
        // Fewer tell no slope: all light is taken to follow the emission.
        constexpr std::size_t least_batches = 8;
        follows_.assign(first_of_emission_, 1.0);
        if (sums_.batches() < least_batches) return;
        regressed_ = true;
        for (std::size_t i = 0; i < follows_.size(); ++i) {
            follows_[i] = std::clamp(sums_.relative_slope(i, first_of_emission_ + i % 3), 0.0, 1.0);
        }
    }

    // part 0 to 2: X, Y, Z.
    template <typename Mean>
    double value(Mean&& mean, std::size_t bin, std::size_t part) const {
        const std::size_t i = 3 * bin + part;
        const double reading = mean(i);
        if (follows_[i] == 0.0) return reading;
        return reading * std::pow(emission_[static_cast<Eigen::Index>(part)] /
                                      mean(first_of_emission_ + part),
                                  follows_[i]);
    }
    double value(std::size_t bin, std::size_t part) const {
        return value([&](std::size_t i) { return sums_.mean(i); }, bin, part);
    }

    // f(value), where value(bin, part) are those of the means; less one degree of freedom for the
    // slope.
    template <typename Functional>
    Uncertain of(const Functional& functional) const {
        Uncertain result = sums_.of([&](auto&& mean) {
            return functional(
                [&](std::size_t bin, std::size_t part) { return value(mean, bin, part); });
        });
        if (regressed_) result.degrees_of_freedom -= 1.0;
        return result;
    }

private:
    const BatchMeans& sums_;
    const Vec3& emission_;
    std::size_t first_of_emission_;
    std::vector<double> follows_;
    bool regressed_ = false;
};

Uncertain Readings::result_of_sensor(const Calibration& calibration, std::size_t bin) const {
    const Estimate& estimate = luminance_[bin];
    Uncertain result = calibration.of([&](auto&& value) { return value(bin, 1); });
    result.bias_left = std::max(estimate.bias_left(), steps_[bin].beyond_noise());
    return result;
}

double Readings::worst_sensor(const SceneParts& parts, const Settings& targets) const {
    const Calibration calibration(*this);
    double worst = 0.0;
    for (std::size_t i = 0; i < observers_.size(); ++i) {
        if (is_camera_[i]) continue;
        const SensorTarget target =
            targets.target_of(name_of(parts.observers[observers_[i].observer]));
        double t = 0.0;  // the same for all bins
        for (std::size_t bin = 0; bin < observers_[i].count; ++bin) {
            const Uncertain result = result_of_sensor(calibration, observers_[i].first_bin + bin);
            if (result.degrees_of_freedom < 1.0) return infinity;
            if (bin == 0) t = student_t(target_coverage, result.degrees_of_freedom);
            const double expanded =
                std::hypot(t * result.standard_error, target_coverage * result.bias_left);
            worst = std::max(worst, target.excess(result.value, expanded));
        }
    }
    return worst;
}

std::vector<Image> Readings::images(const SceneParts& parts) const {
    std::vector<Image> images;
    for (std::size_t i = 0; i < observers_.size(); ++i) {
        if (!is_camera_[i]) continue;
        const ObserverBins& bins = observers_[i];
        const Camera& camera = std::get<Camera>(parts.observers[bins.observer]);
        Image image;
        image.name = camera.name;
        image.width = camera.width;
        image.height = camera.height;
        const auto first = static_cast<std::ptrdiff_t>(bins.first_bin);
        image.luminance.assign(
            luminance_.begin() + first,
            luminance_.begin() + first + static_cast<std::ptrdiff_t>(bins.count));
        image.tiles = means_[i].tiles;
        image.mean = means_[i].whole;
        const ImageError error = image_error(bins);
        image.correction = error.correction;
        if (error.square > 0.0) {
            image.delta = std::sqrt(error.noise / error.square);
            image.delta_bias = std::sqrt(error.bias / error.square);
        }
        for (std::size_t bin = 0; bin < bins.count; ++bin) {
            const Estimate& estimate = image.luminance[bin];
            // The correction keeps the pixel's colour.
            const double scale =
                estimate.mean() != 0.0 ? estimate.value(image.correction) / estimate.mean() : 1.0;
            const double factor = scale / static_cast<double>(estimate.count());
            image.x.push_back(static_cast<float>(x_sum_[bins.first_bin + bin] * factor));
            image.z.push_back(static_cast<float>(z_sum_[bins.first_bin + bin] * factor));
        }
        if (spectral_bins_ > 0) {
            constexpr double range_nm = spectral::max_wavelength_nm - spectral::min_wavelength_nm;
            const double width_nm = range_nm / static_cast<double>(spectral_bins_);
            for (std::size_t edge = 0; edge <= spectral_bins_; ++edge) {
                image.bin_edges_nm.push_back(spectral::min_wavelength_nm +
                                             static_cast<double>(edge) * width_nm);
            }
            const double phases = static_cast<double>(image.luminance.front().count());
            const std::size_t begin = bins.first_bin * spectral_bins_;
            for (std::size_t k = 0; k < bins.count * spectral_bins_; ++k) {
                image.spectral_radiance.push_back(
                    static_cast<float>(spectral_sum_[begin + k] / (phases * width_nm)));
            }
        }
        images.push_back(std::move(image));
    }
    return images;
}

std::optional<Colour> Readings::colour(const Calibration& calibration,
                                       std::size_t sensor_bin) const {
    const spectral::Xyz mean{calibration.value(sensor_bin, 0), calibration.value(sensor_bin, 1),
                             calibration.value(sensor_bin, 2)};
    if (!(mean.x > 0.0 && mean.y > 0.0 && mean.z > 0.0)) return std::nullopt;
    const auto share = [&](std::size_t part) {
        return calibration.of([&](auto&& value) {
            const Vec3 xyz(value(sensor_bin, 0), value(sensor_bin, 1), value(sensor_bin, 2));
            return xyz[static_cast<Eigen::Index>(part)] / xyz.sum();
        });
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
        return calibration.of([&](auto&& xyz) {
            return value + slope.dot(Vec3(xyz(sensor_bin, 0) - mean.x, xyz(sensor_bin, 1) - mean.y,
                                          xyz(sensor_bin, 2) - mean.z));
        });
    };
    colour.cct_k = linear(&spectral::ColourTemperature::cct_k);
    colour.duv = linear(&spectral::ColourTemperature::duv);
    return colour;
}

std::vector<Quantity> Readings::quantities(const SceneParts& parts) const {
    const Calibration calibration(*this);
    std::vector<Quantity> quantities;
    for (std::size_t i = 0; i < observers_.size(); ++i) {
        const ObserverBins& bins = observers_[i];
        const Observer& observer = parts.observers[bins.observer];
        const auto report = [&](std::string name, const char* quantity, const char* unit,
                                std::size_t bin) {
            const std::size_t i = bins.first_bin + bin;
            quantities.push_back({std::move(name), quantity, unit, luminance_[i],
                                  colour(calibration, i), result_of_sensor(calibration, i)});
        };
        if (const auto* points = std::get_if<IlluminancePoints>(&observer)) {
            for (std::size_t k = 0; k < bins.count; ++k) {
                report(point_name(*points, k), "illuminance", "lx", k);
            }
        } else if (const auto* meter = std::get_if<LuminanceMeter>(&observer)) {
            report(meter->name, "luminance", "cd/m2", 0);
        }
    }
    return quantities;
}

std::vector<DerivedQuantity> Readings::derived(const SceneParts& parts) const {
    const Calibration calibration(*this);
    std::vector<DerivedQuantity> derived;
    for (std::size_t i = 0; i < observers_.size(); ++i) {
        const ObserverBins& bins = observers_[i];
        const auto* points = std::get_if<IlluminancePoints>(&parts.observers[bins.observer]);
        if (points == nullptr || bins.count < 2) continue;
        const std::size_t first = bins.first_bin;
        const auto y_of_mean = [&](std::size_t bin) { return calibration.value(bin, 1); };
        std::size_t least = 0;
        std::size_t greatest = 0;
        for (std::size_t k = 0; k < bins.count; ++k) {
            const double value = y_of_mean(first + k);
            if (value < y_of_mean(first + least)) least = k;
            if (value > y_of_mean(first + greatest)) greatest = k;
        }
        const auto mean_of = [&](auto&& value) {
            double sum = 0.0;
            for (std::size_t k = 0; k < bins.count; ++k) sum += value(first + k, 1);
            return sum / static_cast<double>(bins.count);
        };
        const auto at = [&](std::size_t k) {
            return [&, k](auto&& value) { return value(first + k, 1); };
        };
        const auto candidates_for = [&](std::size_t chosen) {
            double candidates = 1.0;
            for (std::size_t k = 0; k < bins.count; ++k) {
                // Points share photons and wavelengths, so that their difference is often known far
                // better than they are.
                const Uncertain apart = calibration.of(
                    [&](auto&& value) { return value(first + k, 1) - value(first + chosen, 1); });
                const bool rival = std::abs(apart.value) <= rival_errors * apart.standard_error;
                if (k != chosen && rival) ++candidates;
            }
            return candidates;
        };
        // What is left of biases of points is not correlated: on the dark side of a step it is
        // light too many, on the bright one too few.
        const auto bias_left = [&](std::size_t k) {
            return result_of_sensor(calibration, first + k).bias_left;
        };
        double square_of_biases = 0.0;
        for (std::size_t k = 0; k < bins.count; ++k) square_of_biases += square(bias_left(k));
        const double bias_of_mean = std::sqrt(square_of_biases) / static_cast<double>(bins.count);
        const auto relative = [](double bias, double value) {
            return value > 0.0 ? bias / value : 0.0;
        };
        const auto report = [&](const char* what, const char* quantity, const char* unit,
                                Uncertain result, double candidates, double bias) {
            result.candidates = candidates;
            result.bias_left = bias;
            derived.push_back({points->name + ": " + what, quantity, unit, result});
        };
        const double of_least = candidates_for(least);
        const double of_greatest = candidates_for(greatest);
        report("mean", "average illuminance", "lx", calibration.of(mean_of), 1.0, bias_of_mean);
        report("minimum", "minimum illuminance", "lx", calibration.of(at(least)), of_least,
               bias_left(least));
        report("maximum", "maximum illuminance", "lx", calibration.of(at(greatest)), of_greatest,
               bias_left(greatest));
        const double of_value = relative(bias_left(least), y_of_mean(first + least));
        const auto ratio_to = [&](auto&& denominator) {
            return calibration.of(
                [&](auto&& value) { return value(first + least, 1) / denominator(value); });
        };
        const auto bias_of_ratio = [&](const Uncertain& ratio, double bias, auto&& denominator) {
            const double value = denominator(
                [&](std::size_t bin, std::size_t part) { return calibration.value(bin, part); });
            return ratio.value * std::hypot(of_value, relative(bias, value));
        };
        const Uncertain uniformity = ratio_to(mean_of);
        report("uniformity U0", "illuminance uniformity, minimum / average", "1", uniformity,
               of_least, bias_of_ratio(uniformity, bias_of_mean, mean_of));
        const Uncertain diversity = ratio_to(at(greatest));
        report("diversity Ud", "illuminance diversity, minimum / maximum", "1", diversity,
               of_least * of_greatest, bias_of_ratio(diversity, bias_left(greatest), at(greatest)));
    }
    return derived;
}

std::size_t Readings::bytes() const {
    const std::size_t of_phase = sizeof(PhaseReadings::Value) + spectral_bins_ * sizeof(double);
    return luminance_.size() * (of_phase + sizeof(Estimate) + 2 * sizeof(double)) +
           spectral_sum_.size() * sizeof(double) + sensors_.bytes() +
           steps_.size() * (sizeof(PhaseReadings::Step) + sizeof(StepBias));
}

}  // namespace lucerna::optics
