#include "optics/transport/readings.h"

#include <algorithm>
#include <bit>

#include "core/parallel.h"
#include "spectral/colorimetry.h"

namespace lucerna::optics {

double Image::corrected_share(std::size_t i) const {
    return luminance[i].corrected_share(relative_bias * luminance[i].mean());
}

Uncertain Image::pixel(std::size_t i) const {
    const Estimate& estimate = luminance[i];
    const double share = corrected_share(i);
    // A bias that is taken off leaves half of it at most: see Estimate::bias_left.
    const double left =
        std::max(1.0 - share, 0.5) * std::sqrt(std::max(0.0, estimate.bias_square()));
    return {estimate.value(share), std::hypot(estimate.standard_error(share), left),
            estimate.degrees_of_freedom()};
}

namespace {

std::size_t tiles_along(std::size_t pixels) {
    constexpr std::size_t size = Image::tile_size;
    return (pixels + size - 1) / size;
}

// Root of a ratio of sums over pixels; 0 where noise makes the first negative, and where nothing is
// known of it after a single phase.
double root_of_ratio(double of_bias, double of_luminance) {
    const double ratio = of_bias / of_luminance;
    return std::isfinite(ratio) ? std::sqrt(std::max(0.0, ratio)) : 0.0;
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

void Readings::Squares::operator+=(const Squares& other) {
    luminance += other.luminance;
    noise += other.noise;
    bias += other.bias;
}

// Sum of what a function tells of each pixel, the same bits for any number of threads.
template <typename Function>
Readings::Squares Readings::sum_over_pixels(const ObserverBins& bins, int threads,
                                            const Function& of_pixel) const {
    constexpr std::size_t per_block = 1 << 11;
    std::vector<Squares> blocks((bins.count + per_block - 1) / per_block);
    for_each_block(blocks.size(), threads, [&](std::size_t block) {
        const std::size_t end = std::min(bins.count, (block + 1) * per_block);
        for (std::size_t bin = block * per_block; bin < end; ++bin) {
            blocks[block] += of_pixel(luminance_[bins.first_bin + bin]);
        }
    });
    Squares all;
    for (const Squares& sum : blocks) all += sum;
    return all;
}

double Readings::relative_bias(const ObserverBins& bins, int threads) const {
    const Squares sums = sum_over_pixels(bins, threads, [](const Estimate& pixel) {
        return Squares{square(pixel.mean()), 0.0, pixel.bias_square()};
    });
    return root_of_ratio(sums.bias, sums.luminance);
}

Readings::Squares Readings::of_corrected(const ObserverBins& bins, double relative_bias,
                                         int threads) const {
    return sum_over_pixels(bins, threads, [&](const Estimate& pixel) {
        const double share = pixel.corrected_share(relative_bias * pixel.mean());
        return Squares{square(pixel.value(share)), square(pixel.standard_error(share)),
                       square(1.0 - share) * pixel.bias_square()};
    });
}

double Readings::image_variance() const {
    double sum = 0.0;
    for (std::size_t i = 0; i < observers_.size(); ++i) {
        if (!is_camera_[i]) continue;
        const ObserverBins& bins = observers_[i];
        for (std::size_t bin = bins.first_bin; bin < bins.first_bin + bins.count; ++bin) {
            const Estimate& pixel = luminance_[bin];
            sum += square(pixel.mean_standard_error()) * static_cast<double>(pixel.count());
        }
    }
    return sum;
}

double Readings::delta(int threads) const {
    Squares sums;
    for (std::size_t i = 0; i < observers_.size(); ++i) {
        if (!is_camera_[i]) continue;
        sums += of_corrected(observers_[i], relative_bias(observers_[i], threads), threads);
    }
    return sums.luminance > 0.0 ? std::sqrt(sums.noise / sums.luminance) : 0.0;
}

std::vector<Image> Readings::images(const SceneParts& parts, int threads) const {
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
        image.relative_bias = relative_bias(bins, threads);
        const Squares sums = of_corrected(bins, image.relative_bias, threads);
        if (sums.luminance > 0.0) image.delta = std::sqrt(sums.noise / sums.luminance);
        image.delta_bias = root_of_ratio(sums.bias, sums.luminance);
        for (std::size_t bin = 0; bin < bins.count; ++bin) {
            const Estimate& estimate = image.luminance[bin];
            // The correction keeps the pixel's colour.
            const double scale = estimate.mean() != 0.0
                                     ? estimate.value(image.corrected_share(bin)) / estimate.mean()
                                     : 1.0;
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
