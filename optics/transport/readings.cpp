#include "optics/transport/readings.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/parallel.h"

namespace lucerna::optics {
namespace {

constexpr std::size_t samples_per_block = 1024;
// Backward rays that all sensors of an observer share in a phase, within limits per point.
constexpr std::size_t sensor_samples_per_phase = 20000;

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

Readings::Readings(const SceneParts& parts, const Settings& settings)
    : spectral_bins_(static_cast<std::size_t>(settings.spectral_bins)) {
    std::size_t bins = 0;
    for (std::size_t i = 0; i < parts.observers.size(); ++i) {
        const bool camera = std::holds_alternative<Camera>(parts.observers[i]);
        const std::size_t count = bins_of(parts.observers[i]);
        if (count == 0) continue;
        const std::size_t samples =
            camera ? static_cast<std::size_t>(settings.samples_per_pixel)
                   : std::clamp<std::size_t>(sensor_samples_per_phase / count, 16, 4096);
        const std::size_t block = std::max<std::size_t>(1, samples_per_block / samples);
        for (std::size_t first = 0; first < count; first += block) {
            blocks_.push_back({observers_.size(), first, std::min(count, first + block)});
        }
        observers_.push_back({i, bins, count, static_cast<std::uint32_t>(samples),
                              static_cast<std::uint32_t>(samples_)});
        is_camera_.push_back(camera);
        means_.emplace_back();
        if (camera) {
            const Camera& view = std::get<Camera>(parts.observers[i]);
            ImageMeans& means = means_.back();
            means.width = static_cast<std::size_t>(view.width);
            means.height = static_cast<std::size_t>(view.height);
            means.tiles.resize(tiles_along(means.width) * tiles_along(means.height));
        }
        bins += count;
        samples_ += count * samples;
    }
    phase_.resize(bins);
    luminance_.resize(bins);
    x_sum_.resize(bins);
    z_sum_.resize(bins);
    spectral_sum_.resize(bins * spectral_bins_);
}

void Readings::add(const Phase& phase, std::size_t bin, const Lanes& radiance) {
    PhaseValue& value = phase_[bin];
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
        spectral_sum_[bin * spectral_bins_ + spectral_bin] +=
            static_cast<double>(radiance[lane] * phase.wavelengths.interval_nm[lane]);
    }
}

void Readings::fold_means(const ObserverBins& bins, ImageMeans& means) {
    const std::size_t columns = tiles_along(means.width);
    std::vector<double> sums(means.tiles.size());
    std::vector<double> biases(means.tiles.size());
    std::vector<double> pixels(means.tiles.size());
    for (std::size_t row = 0; row < means.height; ++row) {
        for (std::size_t column = 0; column < means.width; ++column) {
            const PhaseValue& value = phase_[bins.first_bin + row * means.width + column];
            const std::size_t tile = row / Image::tile_size * columns + column / Image::tile_size;
            sums[tile] += value.y;
            biases[tile] += value.bias;
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

void Readings::fold(int threads) {
    for_each_block(observers_.size(), threads, [&](std::size_t i) {
        if (is_camera_[i]) fold_means(observers_[i], means_[i]);
    });
    constexpr std::size_t block = 1 << 14;
    for_each_block((phase_.size() + block - 1) / block, threads, [&](std::size_t b) {
        const std::size_t end = std::min(phase_.size(), (b + 1) * block);
        for (std::size_t bin = b * block; bin < end; ++bin) {
            luminance_[bin].add(phase_[bin].y, phase_[bin].bias);
            x_sum_[bin] += phase_[bin].x;
            z_sum_[bin] += phase_[bin].z;
            phase_[bin] = {};
        }
    });
}

double Readings::delta() const {
    double variance = 0.0;
    double square = 0.0;
    for (std::size_t i = 0; i < observers_.size(); ++i) {
        if (!is_camera_[i]) continue;
        for (std::size_t bin = 0; bin < observers_[i].count; ++bin) {
            const Estimate& estimate = luminance_[observers_[i].first_bin + bin];
            const double error = estimate.standard_error();
            variance += error * error;
            square += estimate.mean() * estimate.mean();
        }
    }
    return square > 0.0 ? std::sqrt(variance / square) : 0.0;
}

double Readings::worst_sensor_error() const {
    double worst = 0.0;
    for (std::size_t i = 0; i < observers_.size(); ++i) {
        if (is_camera_[i]) continue;
        for (std::size_t bin = 0; bin < observers_[i].count; ++bin) {
            const Estimate& estimate = luminance_[observers_[i].first_bin + bin];
            const double error = estimate.standard_error();
            if (error > 0.0) worst = std::max(worst, error / std::abs(estimate.mean()));
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
        double variance = 0.0;
        double square = 0.0;
        double bias = 0.0;
        for (std::size_t bin = 0; bin < bins.count; ++bin) {
            const Estimate& estimate = image.luminance[bin];
            const double phases = static_cast<double>(estimate.count());
            image.x.push_back(static_cast<float>(x_sum_[bins.first_bin + bin] / phases));
            image.z.push_back(static_cast<float>(z_sum_[bins.first_bin + bin] / phases));
            variance += estimate.standard_error() * estimate.standard_error();
            square += estimate.mean() * estimate.mean();
            // Its own noise would otherwise pass for bias.
            const double noise = estimate.bias_standard_error();
            bias += estimate.bias() * estimate.bias() - noise * noise;
        }
        if (square > 0.0) {
            image.delta = std::sqrt(variance / square);
            image.delta_bias = std::sqrt(std::max(0.0, bias) / square);
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

std::vector<Quantity> Readings::quantities(const SceneParts& parts) const {
    std::vector<Quantity> quantities;
    for (const ObserverBins& bins : observers_) {
        const Observer& observer = parts.observers[bins.observer];
        const auto report = [&](std::string name, const char* quantity, const char* unit,
                                std::size_t bin) {
            const Estimate& estimate = luminance_[bin];
            const double phases = static_cast<double>(estimate.count());
            quantities.push_back({std::move(name), quantity, unit, estimate, x_sum_[bin] / phases,
                                  z_sum_[bin] / phases});
        };
        if (const auto* points = std::get_if<IlluminancePoints>(&observer)) {
            for (std::size_t k = 0; k < bins.count; ++k) {
                const auto columns = static_cast<std::size_t>(std::max(1, points->columns));
                const std::string name =
                    points->columns > 0
                        ? fmt::format("{}[{},{}]", points->name, k % columns, k / columns)
                    : bins.count > 1 ? fmt::format("{}[{}]", points->name, k)
                                     : points->name;
                report(name, "illuminance", "lx", bins.first_bin + k);
            }
        } else if (const auto* meter = std::get_if<LuminanceMeter>(&observer)) {
            report(meter->name, "luminance", "cd/m2", bins.first_bin);
        }
    }
    return quantities;
}

std::size_t Readings::bytes() const {
    return phase_.size() * (sizeof(PhaseValue) + sizeof(Estimate) + 2 * sizeof(double)) +
           spectral_sum_.size() * sizeof(double);
}

}  // namespace lucerna::optics
