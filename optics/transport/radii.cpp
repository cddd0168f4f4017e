#include "optics/transport/radii.h"

#include <algorithm>
#include <numbers>

#include "optics/transport/forward_map.h"

namespace lucerna::optics {
namespace {

constexpr std::size_t probes_per_patch = 64;
constexpr std::size_t neighbours = 12;

// Median over some of the points of the squared distance to their `neighbours`-th nearest.
double median_square_distance(const std::vector<Vec3>& points) {
    std::vector<double> probes;
    const std::size_t step = std::max<std::size_t>(1, points.size() / probes_per_patch);
    for (std::size_t i = 0; i < points.size(); i += step) {
        std::vector<double> squares;
        squares.reserve(points.size());
        for (const Vec3& other : points) squares.push_back((other - points[i]).squaredNorm());
        std::nth_element(squares.begin(), squares.begin() + neighbours, squares.end());
        probes.push_back(squares[neighbours]);
    }
    std::nth_element(probes.begin(), probes.begin() + static_cast<long>(probes.size() / 2),
                     probes.end());
    return probes[probes.size() / 2];
}

// What the bias of a kernel may be, as a share of the light and root mean square over its places;
// about the square of it is left when it is taken off.
constexpr double small_sensor_bias = 0.05;
constexpr double small_surface_bias = 0.15;

// The widest radius, at most limit_m, at which the photon density around the points shows no more
// than that bias; not so narrow that hardly a photon is left.
double radius_of_small_bias(const std::vector<Vec3>& photons, const std::vector<Vec3>& points,
                            double limit_m, double small_bias) {
    constexpr std::size_t most_points = 64;
    constexpr double least_photons = 4.0;  // per point
    const std::size_t step = std::max<std::size_t>(1, points.size() / most_points);
    std::vector<std::vector<double>> distances_m;  // per point, sorted
    for (std::size_t i = 0; i < points.size(); i += step) {
        auto& of_point = distances_m.emplace_back();
        for (const Vec3& photon : photons) {
            const double distance_m = (photon - points[i]).norm();
            if (distance_m < limit_m && distance_m > 0.0) of_point.push_back(distance_m);
        }
        std::sort(of_point.begin(), of_point.end());
    }
    const auto within = [](const std::vector<double>& sorted, double radius_m) {
        return static_cast<double>(std::lower_bound(sorted.begin(), sorted.end(), radius_m) -
                                   sorted.begin());
    };
    // A lucky look at one radius must not decide: the next narrower one has to pass as well.
    bool wider_passed = false;
    for (double radius_m = limit_m;; radius_m /= std::numbers::sqrt2) {
        double photon_count = 0.0;
        double bias_square = 0.0;
        double square = 0.0;
        for (const auto& of_point : distances_m) {
            const double all = within(of_point, radius_m);
            const double inner = within(of_point, inner_radius_factor * radius_m);
            // bias = 2 (n(r) - 2 n(r / sqrt 2)) / (pi r^2); the variance of that difference of
            // counts is the number of all.
            const double bias = 2.0 * (all - 2.0 * inner);
            bias_square += bias * bias - 4.0 * all;
            square += all * all;
            photon_count += all;
        }
        const bool passed = bias_square <= small_bias * small_bias * square;
        if (passed && wider_passed) return std::numbers::sqrt2 * radius_m;
        wider_passed = passed;
        if (photon_count < least_photons * static_cast<double>(distances_m.size())) return radius_m;
    }
}

}  // namespace

Radii Radii::at_phase(std::uint32_t number) const {
    constexpr double alpha = 4.0 / 5.0;
    const double factor = std::pow(static_cast<double>(number) + 1.0, (alpha - 1.0) / 2.0);
    std::vector<double> shrunk;
    shrunk.reserve(radii_m_.size());
    for (const double radius : radii_m_) shrunk.push_back(radius * factor);
    return Radii(std::move(shrunk));
}

Radii pilot_radii(const Stage& stage, const SensorPlanes& planes,
                  const std::vector<Photon>& photons, double photons_per_kernel, double scale,
                  bool seen) {
    std::vector<std::vector<Vec3>> positions(stage.patch_count() + planes.count());
    for (const Photon& photon : photons) {
        positions[kernel_patch(stage, photon.point)].push_back(photon.point.position);
    }
    const double scene_limit_m = stage.caster().scene_radius_m() / 20.0;
    std::vector<double> radii_m;
    radii_m.reserve(positions.size());
    for (std::uint32_t patch = 0; patch < positions.size(); ++patch) {
        const bool sensor = patch >= stage.patch_count();
        const double limit_m =
            sensor ? planes.margin_m()
                   : std::min(scene_limit_m, std::sqrt(stage.patch_area_m2(patch)) / 8.0);
        double radius_m = limit_m;
        if (positions[patch].size() > 2 * neighbours) {
            // n photons within d: density n / (pi d^2); wanted K = density * scale * pi r^2.
            const double square = median_square_distance(positions[patch]);
            radius_m = std::sqrt(photons_per_kernel * square / (neighbours * scale));
        }
        radius_m = std::min(limit_m, radius_m);
        if (sensor) {
            std::vector<Vec3> points;
            for (const auto& point : planes.points_of(patch - stage.patch_count())) {
                points.push_back(point.position);
            }
            radius_m = std::max(radius_m, radius_of_small_bias(positions[patch], points, limit_m,
                                                               small_sensor_bias));
        } else if (seen && positions[patch].size() > 2 * neighbours) {
            radius_m = radius_of_small_bias(positions[patch], positions[patch], radius_m,
                                            small_surface_bias);
        }
        radii_m.push_back(radius_m);
    }
    return Radii(std::move(radii_m));
}

}  // namespace lucerna::optics
