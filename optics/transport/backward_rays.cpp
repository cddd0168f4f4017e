#include "optics/transport/backward_rays.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace lucerna::optics {
namespace {

constexpr std::size_t rays_per_block = 1024;
// Backward rays that all sensors of an observer share in a phase, within limits per point.
constexpr std::size_t sensor_rays_per_phase = 20000;
// Backward rays of an image in a phase: enough for their stratification to pay, within limits per
// pixel, and as few as the time and memory of a phase of a large image ask for.
constexpr std::size_t image_rays_per_phase = 1 << 19;
constexpr std::size_t gathers_of_image = 1 << 16;
// In images with so many pixels that each gathers once for its even number of rays; pixels with
// more rays gather as often for each of them.
constexpr std::uint32_t rays_that_share_a_gather = 8;
constexpr std::size_t pilot_rays_of_image = 1 << 18;
constexpr std::size_t pilot_tiles_of_image = 1 << 16;
// A kernel's bias that exceeds its own noise in the pilot phases by so many standard deviations.
constexpr float deviations_of_luck = 4.0f;
// What the noise of kernels is weighed by: short runs have about so many phases.
constexpr float phases_of_a_run = 16.0f;
constexpr int most_narrowings = 3;
// A pixel gets at most this many times the rays of the average one.
constexpr std::uint32_t most_times_even = 32;

std::uint32_t rays_of_pixel(std::size_t pixels, const Settings& settings) {
    if (settings.samples_per_pixel) return static_cast<std::uint32_t>(*settings.samples_per_pixel);
    return static_cast<std::uint32_t>(
        std::bit_floor(std::clamp<std::size_t>(image_rays_per_phase / pixels, 1, 8)));
}

// Edge of the square tiles of an image, one for a pilot ray [pixels].
std::size_t tile_of(std::size_t pixels) {
    std::size_t tile = 1;
    while (tile * tile * pilot_tiles_of_image < pixels) ++tile;
    return tile;
}

struct Pixel {
    float deviation;  // of the luminance of a ray
    float cost;       // segments of its path
};

// Sum over the pixels around each one, up to `reach` of them to each side.
template <typename T>
std::vector<T> summed_around(int width, int height, const T* values, int reach) {
    const auto along = [&](const T* from, int count, int lines, int step, int line_step) {
        std::vector<T> sums(static_cast<std::size_t>(count * lines));
        for (int line = 0; line < lines; ++line) {
            for (int i = 0; i < count; ++i) {
                T sum{};
                for (int k = std::max(0, i - reach); k <= std::min(count - 1, i + reach); ++k) {
                    sum += from[k * step + line * line_step];
                }
                sums[static_cast<std::size_t>(i * step + line * line_step)] = sum;
            }
        }
        return sums;
    };
    const std::vector<T> rows = along(values, width, height, 1, width);
    return along(rows.data(), height, width, width, 1);
}

// Of a pixel with its neighbours: edges are thinner than the few rays of a single pixel can find.
// Where each pixel had one ray only, as in large images, half of the variance is that of a wider
// surrounding: nine rays miss most of the rare bright events of a region. (With four rays a pixel
// that gains nothing, and edges are blurred: 9 % more error of a diffuse room.)
std::vector<Pixel> pixels_of(const Camera& camera, const RaySums* sums) {
    constexpr int wide = 4;
    const std::vector<RaySums> near = summed_around(camera.width, camera.height, sums, 1);
    std::vector<float> variances;
    for (const RaySums& rays : near) {
        const float mean = rays.luminance / rays.rays;
        variances.push_back(std::max(0.0f, rays.square / rays.rays - mean * mean));
    }
    if (sums->rays <= 1.0f) {
        const std::vector<float> ones(near.size(), 1.0f);
        const std::vector<float> around =
            summed_around(camera.width, camera.height, variances.data(), wide);
        const std::vector<float> counts =
            summed_around(camera.width, camera.height, ones.data(), wide);
        for (std::size_t i = 0; i < variances.size(); ++i) {
            variances[i] = 0.5f * (variances[i] + around[i] / counts[i]);
        }
    }
    std::vector<Pixel> result;
    for (std::size_t i = 0; i < near.size(); ++i) {
        result.push_back({std::sqrt(variances[i]), near[i].segments / near[i].rays});
    }
    return result;
}

// log2 of the number of rays of each pixel, within limits.
std::vector<std::uint8_t> rays_log2(const std::vector<Pixel>& pixels, double scale, double least,
                                    double most) {
    std::vector<std::uint8_t> log2;
    log2.reserve(pixels.size());
    for (const Pixel& pixel : pixels) {
        const double rays = std::clamp(
            scale * static_cast<double>(pixel.deviation / std::sqrt(pixel.cost)), least, most);
        log2.push_back(static_cast<std::uint8_t>(std::lround(std::log2(rays))));
    }
    return log2;
}

double cost_of(const std::vector<Pixel>& pixels, const std::vector<std::uint8_t>& log2) {
    double cost = 0.0;
    for (std::size_t i = 0; i < pixels.size(); ++i)
        cost += std::ldexp(static_cast<double>(pixels[i].cost), log2[i]);
    return cost;
}

}  // namespace

BackwardRays::BackwardRays(const SceneParts& parts, const Readings& readings,
                           const Settings& settings) {
    for (const ObserverBins& bins : readings.observers()) {
        if (is_camera(parts, bins)) {
            const std::uint32_t rays = rays_of_pixel(bins.count, settings);
            const auto gathers = static_cast<std::uint32_t>(
                std::clamp<std::size_t>(gathers_of_image / bins.count, 1, rays));
            const std::uint32_t per_gather = rays / gathers;
            const std::uint32_t shared = gathers > 1 ? per_gather : rays_that_share_a_gather;
            observers_.push_back({.even = rays,
                                  .per_gather = per_gather,
                                  .shared = shared,
                                  .most = rays,
                                  .looks_for_barriers = false});
        } else {
            const auto rays = static_cast<std::uint32_t>(
                std::clamp<std::size_t>(sensor_rays_per_phase / bins.count, 16, 4096));
            observers_.push_back({.even = rays, .per_gather = 1, .shared = 1, .most = rays});
        }
    }
    number(readings);
}

BackwardRays BackwardRays::of_pilot(const SceneParts& parts, const Readings& readings,
                                    std::uint32_t per_pixel) {
    BackwardRays pilot;
    for (const ObserverBins& bins : readings.observers()) {
        const auto rays = static_cast<std::uint32_t>(std::bit_floor(
            std::clamp<std::size_t>(pilot_rays_of_image / bins.count, 1, per_pixel)));
        const std::uint32_t count = is_camera(parts, bins) ? rays : 0;
        pilot.observers_.push_back({.even = count,
                                    .per_gather = 1,
                                    .shared = 1,
                                    .most = rays,
                                    .looks_for_barriers = false});
    }
    pilot.number(readings);
    return pilot;
}

void BackwardRays::number(const Readings& readings) {
    blocks_.clear();
    total_ = 0;
    std::uint64_t paths = 0;
    for (std::size_t i = 0; i < observers_.size(); ++i) {
        Shares& own = observers_[i];
        own.first_path = static_cast<std::uint32_t>(paths);
        const std::size_t bins = readings.observers()[i].count;
        paths += bins * own.most;
        std::size_t first = 0, rays = 0;
        for (std::size_t bin = 0; bin < bins; ++bin) {
            const std::uint32_t count = of(i, bin).count;
            if (rays > 0 && rays + count > rays_per_block) {
                blocks_.push_back({i, first, bin});
                first = bin;
                rays = 0;
            }
            rays += count;
            total_ += count;
        }
        if (rays > 0) blocks_.push_back({i, first, bins});
    }
}

std::vector<BinBlock> BackwardRays::some_of_images(const SceneParts& parts,
                                                   const Readings& readings,
                                                   std::size_t most) const {
    std::vector<BinBlock> of_images;
    for (const BinBlock& block : blocks_) {
        if (is_camera(parts, readings.observers()[block.observer_bins])) of_images.push_back(block);
    }
    std::vector<BinBlock> some;
    const std::size_t count = std::min(most, of_images.size());
    for (std::size_t i = 0; i < count; ++i) {
        some.push_back(of_images[i * of_images.size() / count]);
    }
    return some;
}

std::uint32_t BackwardRays::per_gather() const {
    std::uint32_t largest = 1;
    for (const Shares& own : observers_) largest = std::max(largest, own.per_gather);
    return largest;
}

std::size_t BackwardRays::bytes() const {
    std::size_t bytes = blocks_.size() * sizeof(BinBlock);
    for (const Shares& own : observers_) {
        bytes += own.log2.size() + own.kernels.size() * sizeof(Kernel);
    }
    return bytes;
}

void BackwardRays::share_out(const SceneParts& parts, const Readings& readings,
                             const std::vector<RaySums>& sums, bool noise_everywhere) {
    for (std::size_t i = 0; i < observers_.size(); ++i) {
        const ObserverBins& bins = readings.observers()[i];
        if (!is_camera(parts, bins)) continue;
        Shares& own = observers_[i];
        const std::vector<Pixel> pixels = pixels_of(
            std::get<Camera>(parts.observers[bins.observer]), sums.data() + bins.first_bin);
        float largest = 0.0f;
        double cost = 0.0;
        for (const Pixel& pixel : pixels) {
            largest = std::max(largest, pixel.deviation);
            cost += static_cast<double>(pixel.cost);
        }
        if (largest == 0.0f) continue;
        own.most = most_times_even * own.even;
        const double least = noise_everywhere ? 2 * own.even : std::max(1u, own.even / 2);
        const double wanted = (noise_everywhere ? 1.25 : 2.0) * least * cost;
        // The cost grows with the scale in steps: the largest that is not above what is wanted.
        double low = 0.0, high = own.most * 1e6 / static_cast<double>(largest);
        for (int step = 0; step < 60; ++step) {
            const double scale = 0.5 * (low + high);
            (cost_of(pixels, rays_log2(pixels, scale, least, own.most)) <= wanted ? low : high) =
                scale;
        }
        own.log2 = rays_log2(pixels, low, least, own.most);
    }
    number(readings);
}

BackwardRays BackwardRays::through_tiles(const SceneParts& parts, const Readings& readings) {
    BackwardRays rays = of_pilot(parts, readings, 1);
    for (std::size_t i = 0; i < rays.observers_.size(); ++i) {
        const ObserverBins& bins = readings.observers()[i];
        if (!is_camera(parts, bins)) continue;
        rays.observers_[i].looks_for_barriers = true;
        rays.observers_[i].tile = tile_of(bins.count);
        rays.observers_[i].width =
            static_cast<std::size_t>(std::get<Camera>(parts.observers[bins.observer]).width);
    }
    rays.number(readings);
    return rays;
}

void BackwardRays::look_at_kernels(const SceneParts& parts, const Readings& readings,
                                   std::span<const std::vector<RaySums>> pilots) {
    const auto phases = static_cast<float>(pilots.size());
    for (std::size_t i = 0; i < observers_.size(); ++i) {
        const ObserverBins& bins = readings.observers()[i];
        if (!is_camera(parts, bins)) continue;
        const auto& camera = std::get<Camera>(parts.observers[bins.observer]);
        const auto tile = static_cast<int>(tile_of(bins.count));
        const int width = (camera.width + tile - 1) / tile;
        const int height = (camera.height + tile - 1) / tile;
        // The bias of a phase is noisy; its square is the mean product of those of two phases,
        // whose noise is independent.
        const auto tiles = static_cast<std::size_t>(width * height);
        std::vector<float> products(tiles), variances(tiles), barriers(tiles);
        for (std::size_t bin = 0; bin < bins.count; ++bin) {
            const int x = static_cast<int>(bin) % camera.width / tile;
            const int y = static_cast<int>(bin) / camera.width / tile;
            const auto at = static_cast<std::size_t>(y * width + x);
            float sum = 0.0f, squares = 0.0f;
            for (const std::vector<RaySums>& pilot : pilots) {
                const RaySums& rays = pilot[bins.first_bin + bin];
                sum += rays.kernel_bias;
                squares += rays.kernel_bias * rays.kernel_bias;
                barriers[at] += rays.barriers;
            }
            if (pilots.size() < 2) continue;
            products[at] += (sum * sum - squares) / (phases * (phases - 1.0f));
            variances[at] += (squares - sum * sum / phases) / (phases - 1.0f);
        }
        const std::vector<float> counts =
            summed_around(width, height, std::vector<float>(tiles, 1.0f).data(), 1);
        const std::vector<float> products_around = summed_around(width, height, products.data(), 1);
        variances = summed_around(width, height, variances.data(), 1);
        barriers = summed_around(width, height, barriers.data(), 1);
        // Standard deviation of the mean product if there is no bias.
        const float luck = pilots.size() < 2 ? 0.0f : std::sqrt(2.0f / (phases * (phases - 1.0f)));
        std::vector<Kernel> of_tiles(tiles);
        for (std::size_t at = 0; at < tiles; ++at) {
            of_tiles[at].barriers = barriers[at] > 0.0f;
            // By its own bias, which a tile shares with its neighbours where kernels are wider.
            const float variance = variances[at] / counts[at];
            float bias = std::min(products[at], products_around[at] / counts[at]);
            if (!(bias > deviations_of_luck * luck * variance)) continue;
            // A radius smaller by sqrt 2 has twice the noise, and at most 0.7 times the bias, as
            // beside a kink. The noise of a bias is twice that of the light.
            float noise = variance / (4.0f * phases_of_a_run);
            for (int step = 0; step < most_narrowings && noise < 0.5f * bias; ++step) {
                noise *= 2.0f;
                bias *= 0.5f;
                of_tiles[at].scale *= static_cast<float>(inner_radius_factor);
            }
        }
        std::vector<Kernel>& kernels = observers_[i].kernels;
        kernels.clear();
        for (std::size_t bin = 0; bin < bins.count; ++bin) {
            const int x = static_cast<int>(bin) % camera.width / tile;
            const int y = static_cast<int>(bin) / camera.width / tile;
            kernels.push_back(of_tiles[static_cast<std::size_t>(y * width + x)]);
        }
    }
}

void BackwardRays::take_kernels(const BackwardRays& other) {
    for (std::size_t i = 0; i < observers_.size(); ++i) {
        observers_[i].kernels = other.observers_[i].kernels;
    }
}

}  // namespace lucerna::optics
