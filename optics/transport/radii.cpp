#include "optics/transport/radii.h"

#include <algorithm>
#include <numbers>

#include "core/parallel.h"
#include "optics/transport/forward_map.h"
#include "optics/transport/pilot_light.h"

namespace lucerna::optics {
namespace {

constexpr std::size_t probes_per_patch = 64;
constexpr std::size_t neighbours = 12;

// Median over some of the points of the squared distance to their `neighbours`-th nearest.
double median_square_distance(const std::vector<Arrival>& points, int threads) {
    const std::size_t step = std::max<std::size_t>(1, points.size() / probes_per_patch);
    std::vector<double> probes((points.size() + step - 1) / step);
    for_each_block(probes.size(), threads, [&](std::size_t i) {
        std::vector<double> squares;
        squares.reserve(points.size());
        for (const Arrival& other : points) {
            squares.push_back((other.position - points[i * step].position).squaredNorm());
        }
        std::nth_element(squares.begin(), squares.begin() + neighbours, squares.end());
        probes[i] = squares[neighbours];
    });
    std::nth_element(probes.begin(), probes.begin() + static_cast<long>(probes.size() / 2),
                     probes.end());
    return probes[probes.size() / 2];
}

// A surface's kernel is narrowed only where its bias is shown to be large: as a share of the light,
// root mean square over the points, with so many standard deviations of pilot noise allowed for.
constexpr double bias_of_surfaces = 0.15;
constexpr double noise_allowed = 2.0;

// The widest radius, at most limit_m, whose bias keeps within the limit where photons are, and that
// of the next narrower one as well: a lucky look must not decide.
double radius_of_small_bias(const std::vector<Arrival>& photons, double limit_m, int threads) {
    constexpr std::size_t most_points = 64;
    constexpr double least_photons = 4.0;  // per point
    const std::size_t stride = std::max<std::size_t>(1, photons.size() / most_points);
    std::vector<Vec3> points;
    for (std::size_t i = 0; i < photons.size(); i += stride) points.push_back(photons[i].position);
    const auto of_points = LightByRadius::around(points, photons, limit_m, threads);
    const auto n = static_cast<double>(of_points.size());
    bool wider_passed = false;
    double radius_m = limit_m;
    for (std::size_t step = 0; step < LightByRadius::steps;
         ++step, radius_m /= std::numbers::sqrt2) {
        double photon_count = 0.0;
        double variance = 0.0;
        double bias_square = 0.0;
        double square = 0.0;
        for (const LightByRadius& light : of_points) {
            const double all = light.flux[step];
            // bias = 2 (F(r) - 2 F(r / sqrt 2)) / (pi r^2); the variance of that difference of
            // fluxes is the sum of their squares.
            const double bias = 2.0 * (all - 2.0 * light.flux[step + 1]);
            bias_square += bias * bias - 4.0 * light.squares[step];
            square += all * all;
            photon_count += all;
            variance += light.squares[step];
        }
        // With k photons at each of n points, bias_square has the standard deviation k sqrt(32 n).
        const double noise = variance * std::sqrt(32.0 / n);
        const bool passed =
            bias_square <= bias_of_surfaces * bias_of_surfaces * square + noise_allowed * noise;
        if (passed && wider_passed) return std::numbers::sqrt2 * radius_m;
        wider_passed = passed;
        if (photon_count < least_photons * n) break;
    }
    return radius_m;
}

// @param photons  of the pilot trace in a kernel; what surfaces and sensors ask for comes on top.
Radii radii_of(const Stage& stage, const SensorPlanes& planes, const PilotPhotons& pilot,
               const PhotonsPerKernel& photons, bool seen, int threads) {
    const auto arrivals = arrivals_by_patch(stage, planes, pilot);
    std::vector<double> radii_m;
    radii_m.reserve(arrivals.size());
    for (std::uint32_t patch = 0; patch < arrivals.size(); ++patch) {
        const bool sensor = patch >= stage.patch_count();
        const double limit_m = seen ? limit_of_seen_patch_m(stage, planes, patch)
                                    : limit_of_patch_m(stage, planes, patch);
        double radius_m = limit_m;
        const double photons_per_kernel = sensor ? photons.of_sensors : photons.of_surfaces;
        if (arrivals[patch].size() > 2 * neighbours && photons_per_kernel < infinity) {
            // n photons within d: density n / (pi d^2); wanted K = density * pi r^2.
            const double square_m2 = median_square_distance(arrivals[patch], threads);
            radius_m = std::min(limit_m, std::sqrt(photons_per_kernel * square_m2 / neighbours));
        }
        if (seen && !sensor && arrivals[patch].size() > 2 * neighbours) {
            radius_m = radius_of_small_bias(arrivals[patch], radius_m, threads);
        }
        radii_m.push_back(radius_m);
    }
    return Radii(std::move(radii_m));
}

}  // namespace

Radii Radii::at_phase(std::uint32_t number) const {
    constexpr double alpha = 4.0 / 5.0, alpha_of_cut = 2.0 / 3.0;
    const double phase = static_cast<double>(number) + 1.0;
    const double factor = std::pow(phase, (alpha - 1.0) / 2.0);
    Radii shrunk = *this;
    for (double& radius : shrunk.radii_m_) radius *= factor;
    for (double& radius : shrunk.of_points_m_) radius *= factor;
    if (tells_cut_) shrunk.share_of_cut_ = std::pow(phase, (alpha_of_cut - alpha) / 2.0);
    return shrunk;
}

Radii narrow_radii(const Stage& stage, const SensorPlanes& planes, const PilotPhotons& pilot,
                   const PhotonsPerKernel& photons, std::uint32_t rays, bool seen, int threads) {
    const double share = static_cast<double>(pilot.rays) / rays;
    return radii_of(stage, planes, pilot, {share * photons.of_surfaces, share * photons.of_sensors},
                    seen, threads);
}

Radii wide_radii(const Stage& stage, const SensorPlanes& planes, const PilotPhotons& pilot,
                 int threads) {
    Radii radii = radii_of(stage, planes, pilot, {infinity, infinity}, true, threads);
    radii.tell_cut_kernels_apart();
    return radii;
}

std::uint32_t rays_for(const Stage& stage, const PilotPhotons& pilot, const Radii& radii,
                       double photons_per_kernel) {
    std::vector<double> counts(stage.patch_count());
    for (const Photon& photon : pilot.photons) {
        if (photon.point.object != no_object) counts[stage.patch_index(photon.point)] += 1.0;
    }
    // What a photon finds around itself, in the mean over all photons.
    double found = 0.0, all = 0.0;
    for (std::uint32_t patch = 0; patch < counts.size(); ++patch) {
        const double kernel_share = pi * square(radii[patch]) / stage.patch_area_m2(patch);
        found += counts[patch] * counts[patch] * kernel_share;
        all += counts[patch];
    }
    if (!(found > 0.0)) return 0;
    const double rays = pilot.rays * photons_per_kernel * all / found;
    return static_cast<std::uint32_t>(std::min(rays, 1e9));
}

}  // namespace lucerna::optics
