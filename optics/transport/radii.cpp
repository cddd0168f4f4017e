#include "optics/transport/radii.h"

#include <algorithm>

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

}  // namespace

Radii Radii::at_phase(std::uint32_t number) const {
    constexpr double alpha = 2.0 / 3.0;
    const double factor = std::pow(static_cast<double>(number) + 1.0, (alpha - 1.0) / 2.0);
    std::vector<double> shrunk;
    shrunk.reserve(radii_m_.size());
    for (const double radius : radii_m_) shrunk.push_back(radius * factor);
    return Radii(std::move(shrunk));
}

Radii pilot_radii(const Stage& stage, const std::vector<Photon>& photons, double photons_per_kernel,
                  double scale, std::uint32_t sensor_planes, double sensor_limit_m) {
    std::vector<std::vector<Vec3>> positions(stage.patch_count() + sensor_planes);
    for (const Photon& photon : photons) {
        positions[kernel_patch(stage, photon.point)].push_back(photon.point.position);
    }
    const double scene_limit_m = stage.caster().scene_radius_m() / 20.0;
    std::vector<double> radii_m;
    radii_m.reserve(positions.size());
    for (std::uint32_t patch = 0; patch < positions.size(); ++patch) {
        const bool sensor = patch >= stage.patch_count();
        const double limit_m =
            sensor ? sensor_limit_m
                   : std::min(scene_limit_m, std::sqrt(stage.patch_area_m2(patch)) / 8.0);
        double radius_m = limit_m;
        if (positions[patch].size() > 2 * neighbours) {
            // n photons within d: density n / (pi d^2); wanted K = density * scale * pi r^2.
            const double square = median_square_distance(positions[patch]);
            radius_m = std::sqrt(photons_per_kernel * square / (neighbours * scale));
        }
        radii_m.push_back(std::min(limit_m, radius_m));
    }
    return Radii(std::move(radii_m));
}

}  // namespace lucerna::optics
