#include "optics/transport/backward_rays.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/parallel.h"

namespace lucerna::optics {
namespace {

constexpr std::size_t rays_per_block = 256;
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
    float log2_wish;  // of rays, in proportion: deviation of a ray / sqrt(its cost)
    float cost;       // segments of a ray's path
};

// Sum over the pixels around each one, up to `reach` of them to each side.
template <typename T>
std::vector<T> summed_around(int width, int height, const T* values, int reach, int threads) {
    const auto along = [&](const T* from, int count, int lines, int step, int line_step) {
        std::vector<T> sums(static_cast<std::size_t>(count * lines));
        for_each_block(static_cast<std::size_t>(lines), threads, [&](std::size_t of_line) {
            const int line = static_cast<int>(of_line);
            for (int i = 0; i < count; ++i) {
                T sum{};
                for (int k = std::max(0, i - reach); k <= std::min(count - 1, i + reach); ++k) {
                    sum += from[k * step + line * line_step];
                }
                sums[static_cast<std::size_t>(i * step + line * line_step)] = sum;
            }
        });
        return sums;
    };
    const std::vector<T> rows = along(values, width, height, 1, width);
    return along(rows.data(), height, width, width, 1);
}

// Of a pixel with its neighbours: edges are thinner than the few rays of a single pixel can find.
// Where each pixel had one ray only, as in large images, half of the variance is that of a wider
// surrounding: nine rays miss most of the rare bright events of a region. (With four rays a pixel
// that gains nothing, and edges are blurred: 9 % more error of a diffuse room.)
std::vector<Pixel> pixels_of(const Camera& camera, const RaySums* sums, int threads) {
    constexpr int wide = 4;
    const auto around = [&](const auto* values, int reach) {
        return summed_around(camera.width, camera.height, values, reach, threads);
    };
    const std::vector<RaySums> near = around(sums, 1);
    std::vector<float> variances;
    for (const RaySums& rays : near) {
        const float mean = rays.luminance / rays.rays;
        variances.push_back(std::max(0.0f, rays.square / rays.rays - mean * mean));
    }
    if (sums->rays <= 1.0f) {
        const std::vector<float> ones(near.size(), 1.0f);
        const std::vector<float> sums_around = around(variances.data(), wide);
        const std::vector<float> counts = around(ones.data(), wide);
        for (std::size_t i = 0; i < variances.size(); ++i) {
            variances[i] = 0.5f * (variances[i] + sums_around[i] / counts[i]);
        }
    }
    std::vector<Pixel> result;
    for (std::size_t i = 0; i < near.size(); ++i) {
        const float cost = near[i].segments / near[i].rays;
        result.push_back({0.5f * std::log2(variances[i] / cost), cost});
    }
    return result;
}

// How many rays pixels get for their wishes.
struct Scale {
    float log2_scale;
    float log2_least, log2_most;  // of a pixel

    std::uint8_t rays_log2(const Pixel& pixel) const {
        return static_cast<std::uint8_t>(
            std::clamp(log2_scale + pixel.log2_wish, log2_least, log2_most) + 0.5f);
    }
};

// Segments of all rays.
double cost_of(const std::vector<Pixel>& pixels, const Scale& scale, int threads) {
    constexpr std::size_t per_block = 1 << 12;
    std::vector<double> costs((pixels.size() + per_block - 1) / per_block);
    for_each_block(costs.size(), threads, [&](std::size_t block) {
        const std::size_t end = std::min(pixels.size(), (block + 1) * per_block);
        for (std::size_t i = block * per_block; i < end; ++i) {
            const auto rays = static_cast<double>(1u << scale.rays_log2(pixels[i]));
            costs[block] += rays * static_cast<double>(pixels[i].cost);
        }
    });
    return std::accumulate(costs.begin(), costs.end(), 0.0);
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
        some.push_back(of_images[spread_out(i, count, of_images.size())]);
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
                             const std::vector<RaySums>& sums, bool noise_everywhere, int threads) {
    for (std::size_t i = 0; i < observers_.size(); ++i) {
        const ObserverBins& bins = readings.observers()[i];
        if (!is_camera(parts, bins)) continue;
        Shares& own = observers_[i];
        const std::vector<Pixel> pixels =
            pixels_of(std::get<Camera>(parts.observers[bins.observer]),
                      sums.data() + bins.first_bin, threads);
        constexpr float none = -std::numeric_limits<float>::infinity();
        float largest = none;
        double cost = 0.0;
        for (const Pixel& pixel : pixels) {
            largest = std::max(largest, pixel.log2_wish);
            cost += static_cast<double>(pixel.cost);
        }
        if (largest == none) continue;
        own.most = most_times_even * own.even;
        const double least = noise_everywhere ? 2 * own.even : std::max(1u, own.even / 2);
        const double wanted = (noise_everywhere ? 1.25 : 2.0) * least * cost;
        // The cost grows with the scale in steps: the largest that is not above what is wanted,
        // from the least rays for all to the most even for a millionth of the largest wish.
        Scale scale{.log2_scale = 0.0f,
                    .log2_least = static_cast<float>(std::log2(least)),
                    .log2_most = std::log2(static_cast<float>(own.most))};
        float low = scale.log2_least - largest, high = scale.log2_most - largest + 20.0f;
        for (int step = 0; step < 24; ++step) {
            scale.log2_scale = 0.5f * (low + high);
            (cost_of(pixels, scale, threads) <= wanted ? low : high) = scale.log2_scale;
        }
        scale.log2_scale = low;
        own.log2.resize(pixels.size());
        std::ranges::transform(pixels, own.log2.begin(),
                               [&](const Pixel& pixel) { return scale.rays_log2(pixel); });
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
                                   std::span<const std::vector<RaySums>> pilots, int threads) {
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
        std::vector<float> products(tiles), variances(tiles), least_variances(tiles),
            barriers(tiles);
        for (std::size_t bin = 0; bin < bins.count; ++bin) {
            const int x = static_cast<int>(bin) % camera.width / tile;
            const int y = static_cast<int>(bin) / camera.width / tile;
            const auto at = static_cast<std::size_t>(y * width + x);
            float sum = 0.0f, squares = 0.0f;
            for (const std::vector<RaySums>& pilot : pilots) {
                const RaySums& rays = pilot[bins.first_bin + bin];
                sum += rays.kernel_bias;
                squares += rays.kernel_bias * rays.kernel_bias;
                least_variances[at] += rays.kernel_bias_variance / phases;
                barriers[at] += rays.barriers;
            }
            if (pilots.size() < 2) continue;
            products[at] += (sum * sum - squares) / (phases * (phases - 1.0f));
            variances[at] += (squares - sum * sum / phases) / (phases - 1.0f);
        }
        const std::vector<float> counts =
            summed_around(width, height, std::vector<float>(tiles, 1.0f).data(), 1, threads);
        const std::vector<float> products_around =
            summed_around(width, height, products.data(), 1, threads);
        variances = summed_around(width, height, variances.data(), 1, threads);
        least_variances = summed_around(width, height, least_variances.data(), 1, threads);
        barriers = summed_around(width, height, barriers.data(), 1, threads);
        // Standard deviation of the mean product if there is no bias.
        const float luck = pilots.size() < 2 ? 0.0f : std::sqrt(2.0f / (phases * (phases - 1.0f)));
        std::vector<Kernel> of_tiles(tiles);
        for (std::size_t at = 0; at < tiles; ++at) {
            of_tiles[at].barriers = barriers[at] > 0.0f;
            // By its own bias, which a tile shares with its neighbours where kernels are wider.
            // A few phases whose kernels share most photons tell a variance badly: by luck it is
            // too small in many places.
            const float variance = std::max(variances[at], least_variances[at]) / counts[at];
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
