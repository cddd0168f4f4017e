#include "optics/transport/readings.h"

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

std::size_t tiles_along(std::size_t pixels) {
    constexpr std::size_t size = Image::tile_size;
    return (pixels + size - 1) / size;
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

void Readings::fold_means(const PhaseReadings& values, const ObserverBins& bins, int threads,
                          ImageMeans& means) {
    const std::size_t columns = tiles_along(means.width);
    std::vector<double> sums(means.tiles.size());
    std::vector<double> biases(means.tiles.size());
    std::vector<double> pixels(means.tiles.size());
    constexpr std::size_t size = Image::tile_size;
    for_each_block(tiles_along(means.height), threads, [&](std::size_t row_of_tiles) {
        const std::size_t end = std::min(means.height, (row_of_tiles + 1) * size);
        for (std::size_t row = row_of_tiles * size; row < end; ++row) {
            for (std::size_t column = 0; column < means.width; ++column) {
                const PhaseReadings::Value& value =
                    values.values_[bins.first_bin + row * means.width + column];
                const std::size_t tile = row_of_tiles * columns + column / size;
                sums[tile] += value.y;
                biases[tile] += value.y_bias;
                pixels[tile] += 1.0;
            }
        }
    });
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
    for (std::size_t i = 0; i < observers_.size(); ++i) {
        if (is_camera_[i]) fold_means(values, observers_[i], threads, means_[i]);
    }
    fold_sensors(phase, values);
    constexpr std::size_t block = 1 << 10;
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

Readings::ImageError Readings::image_error(const ObserverBins& bins, int threads) const {
    struct Sums {
        double noise = 0.0;      // of the pixels as estimated
        double corrected = 0.0;  // with the whole bias taken off
        double correction_noise = 0.0;
        double mean_square = 0.0, product = 0.0, bias_square = 0.0;  // of means and biases
    };
    constexpr std::size_t per_block = 1 << 11;
    std::vector<Sums> blocks((bins.count + per_block - 1) / per_block);
    for_each_block(blocks.size(), threads, [&](std::size_t block) {
        Sums& sums = blocks[block];
        const std::size_t end = std::min(bins.count, (block + 1) * per_block);
        for (std::size_t bin = block * per_block; bin < end; ++bin) {
            const Estimate& pixel = luminance_[bins.first_bin + bin];
            const double mean = pixel.mean(), bias = pixel.bias();
            sums.noise += std::pow(pixel.mean_standard_error(), 2);
            sums.corrected += std::pow(pixel.standard_error(), 2);
            sums.correction_noise += std::pow(pixel.bias_standard_error(), 2);
            sums.mean_square += mean * mean;
            sums.product += mean * bias;
            sums.bias_square += bias * bias;
        }
    });
    Sums all;
    for (const Sums& sums : blocks) {
        all.noise += sums.noise;
        all.corrected += sums.corrected;
        all.correction_noise += sums.correction_noise;
        all.mean_square += sums.mean_square;
        all.product += sums.product;
        all.bias_square += sums.bias_square;
    }
    // The noise of the bias would else pass for bias.
    const double bias = std::max(0.0, all.bias_square - all.correction_noise);
    ImageError error;
    // The error of v - c b is Var v - 2 c Cov(v, b) + c^2 Var b + (1 - c)^2 bias^2; least at
    // c = (bias^2 + Cov) / (bias^2 + Var b).
    // With a single phase nothing is known of either, and all of the bias is taken off.
    const bool known = std::isfinite(all.noise);
    const double covariance =
        known ? 0.5 * (all.noise + all.correction_noise - all.corrected) : 0.0;
    if (known && bias + all.correction_noise > 0.0) {
        error.correction =
            std::clamp((bias + covariance) / (bias + all.correction_noise), 0.0, 1.0);
    }
    const double c = error.correction;
    error.noise = all.noise - 2.0 * c * covariance + c * c * all.correction_noise;
    error.bias = (1.0 - c) * (1.0 - c) * bias;
    error.square = all.mean_square - 2.0 * c * all.product + c * c * all.bias_square;
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

double Readings::delta(int threads) const {
    double variance = 0.0;
    double square = 0.0;
    for (std::size_t i = 0; i < observers_.size(); ++i) {
        if (!is_camera_[i]) continue;
        const ImageError error = image_error(observers_[i], threads);
        variance += error.noise;
        square += error.square;
    }
    return square > 0.0 ? std::sqrt(variance / square) : 0.0;
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
        const ImageError error = image_error(bins, 1);
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

std::size_t Readings::bytes() const {
    const std::size_t of_phase = sizeof(PhaseReadings::Value) + spectral_bins_ * sizeof(double);
    return luminance_.size() * (of_phase + sizeof(Estimate) + 2 * sizeof(double)) +
           spectral_sum_.size() * sizeof(double) + sensors_.bytes() +
           steps_.size() * (sizeof(PhaseReadings::Step) + sizeof(StepBias));
}

}  // namespace lucerna::optics
