#include "optics/transport/radii.h"

#include <algorithm>
#include <array>
#include <numbers>

#include "optics/transport/forward_map.h"

namespace lucerna::optics {
namespace {

constexpr std::size_t probes_per_patch = 64;
constexpr std::size_t neighbours = 12;

// Where a photon arrives, and how much light it stands for.
struct Arrival {
    Vec3 position;
    double flux;
};

// Median over some of the points of the squared distance to their `neighbours`-th nearest.
double median_square_distance(const std::vector<Arrival>& points) {
    std::vector<double> probes;
    const std::size_t step = std::max<std::size_t>(1, points.size() / probes_per_patch);
    for (std::size_t i = 0; i < points.size(); i += step) {
        std::vector<double> squares;
        squares.reserve(points.size());
        for (const Arrival& other : points) {
            squares.push_back((other.position - points[i].position).squaredNorm());
        }
        std::nth_element(squares.begin(), squares.begin() + neighbours, squares.end());
        probes.push_back(squares[neighbours]);
    }
    std::nth_element(probes.begin(), probes.begin() + static_cast<long>(probes.size() / 2),
                     probes.end());
    return probes[probes.size() / 2];
}

// Flux within limit_m, limit_m / sqrt 2, limit_m / 2, ... of a point, the sum of its squares, and
// its first moment about the point, in units of the limit.
constexpr std::size_t radius_steps = 32;  // the last is 2e-5 of the first
struct LightByRadius {
    LightByRadius() { moment.fill(Vec3::Zero()); }
    std::array<double, radius_steps + 1> flux{}, squares{};
    std::array<Vec3, radius_steps + 1> moment;
};

LightByRadius light_around(const Vec3& point, const std::vector<Arrival>& photons, double limit_m) {
    LightByRadius light;
    for (const Arrival& photon : photons) {
        const Vec3 way = (photon.position - point) / limit_m;
        const double square = way.squaredNorm();
        if (square >= 1.0 || square == 0.0) continue;  // a photon is no evidence about itself
        const auto step =
            static_cast<std::size_t>(std::min(-std::log2(square), double{radius_steps}));
        light.flux[step] += photon.flux;
        light.squares[step] += photon.flux * photon.flux;
        light.moment[step] += photon.flux * way;
    }
    for (std::size_t i = radius_steps; i > 0; --i) {
        light.flux[i - 1] += light.flux[i];
        light.squares[i - 1] += light.squares[i];
        light.moment[i - 1] += light.moment[i];
    }
    return light;
}

// In a unit in which photons of equal flux have 1.
void normalise(std::vector<Arrival>& photons) {
    double sum = 0.0, squares = 0.0;
    for (const Arrival& photon : photons) {
        sum += photon.flux;
        squares += photon.flux * photon.flux;
    }
    if (!(squares > 0.0)) return;
    for (Arrival& photon : photons) photon.flux *= sum / squares;
}

// A surface's kernel is narrowed only where its bias is shown to be large: as a share of the light,
// root mean square over the points, with so many standard deviations of pilot noise allowed for.
constexpr double bias_of_surfaces = 0.15;
constexpr double noise_allowed = 2.0;

// The widest radius, at most limit_m, whose bias keeps within the limit at the points, and that of
// the next narrower one as well: a lucky look must not decide.
double radius_of_small_bias(const std::vector<Arrival>& photons, const std::vector<Vec3>& points,
                            double limit_m) {
    constexpr std::size_t most_points = 64;
    constexpr double least_photons = 4.0;  // per point
    const std::size_t stride = std::max<std::size_t>(1, points.size() / most_points);
    std::vector<LightByRadius> of_points;
    for (std::size_t i = 0; i < points.size(); i += stride) {
        of_points.push_back(light_around(points[i], photons, limit_m));
    }
    const auto n = static_cast<double>(of_points.size());
    bool wider_passed = false;
    double radius_m = limit_m;
    for (std::size_t step = 0; step < radius_steps; ++step, radius_m /= std::numbers::sqrt2) {
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

// The radius of least error at the points, 0 without photons. Two independent measurements of the
// bias have its square as the expectation of their product, whatever their noise. Narrow kernels
// tell little of it; but it falls with the radius at least as fast as beside a kink, in proportion,
// so that what a wide kernel shows bounds the narrower ones. A run has the light of many pilots, so
// that its noise weighs less than that of one; to 1 % it has the light of hundreds.
//
// A step that runs through the middle of a kernel shows at no two radii, though the point beside it
// is off by half of its height h. But it makes the light lopsided: with r the radius, its first
// moment is h r^3 2 / 3. A steady slope does that as well and has no bias, so that only a tenth of
// what the moment might mean counts.
//
// Noise is told by the photons of the place: where rays are guided, those elsewhere may be a
// thousand times as heavy.
//
// All errors are those of the irradiance at the points, not in shares of what a kernel holds: a
// wide one beside bright light would be favoured for having much of that. Where the points are
// brighter than what lies around, it is their own irradiance that a bias is a share of.
double radius_of_least_error(const std::vector<Arrival>& one, const std::vector<Arrival>& other,
                             const std::vector<Vec3>& points, double limit_m, double accuracy) {
    constexpr double enough_photons = 8.0;  // of equal flux, to tell the irradiance
    // Of a kernel's flux, if all of the moment over its radius is that of a step: h / 2 pi r^2.
    constexpr double error_per_moment = 0.75 * pi;
    constexpr double share_of_steps = 0.1;
    // Of the accuracy that is asked for: a bias below it matters less than what narrower kernels
    // cost.
    constexpr double small_bias = 1.0 / 3.0;
    const double weight_of_noise = std::min(1.0 / 8.0, square(accuracy / 0.057));
    struct Step {
        double area = 0.0;         // of the kernel, over that of the widest
        double flux = 0.0;         // of one kernel of a point
        double variance = 0.0;     // of that flux
        double bias_square = 0.0;  // of that flux
        double step_square = 0.0;  // of its moment over its radius
        double irradiance() const { return flux / area; }
    };
    std::vector<Step> steps(radius_steps);
    for (std::size_t i = 0; i < radius_steps; ++i) {
        steps[i].area = std::ldexp(1.0, -static_cast<int>(i));
    }
    const double share = 1.0 / static_cast<double>(points.size());
    for (const Vec3& point : points) {
        const LightByRadius a = light_around(point, one, limit_m);
        const LightByRadius b = light_around(point, other, limit_m);
        for (std::size_t i = 0; i < radius_steps; ++i) {
            steps[i].flux += 0.5 * share * (a.flux[i] + b.flux[i]);
            steps[i].variance += 0.5 * share * (a.squares[i] + b.squares[i]);
            steps[i].bias_square +=
                share * 4.0 * (a.flux[i] - 2.0 * a.flux[i + 1]) * (b.flux[i] - 2.0 * b.flux[i + 1]);
            steps[i].step_square += share * a.moment[i].dot(b.moment[i]) / steps[i].area;
        }
    }
    if (!(steps[0].flux > 0.0)) return 0.0;
    double at_points = 0.0;
    for (const Step& step : steps) {
        if (square(step.flux) > enough_photons * step.variance) at_points = step.irradiance();
    }
    double best_m = 0.0;
    double least = infinity;
    double bound = infinity;  // of the square of the bias
    double radius_m = limit_m;
    double of_a_photon = 0.0;  // flux
    for (const Step& step : steps) {
        // Half a standard deviation of the product, if photons are random, is taken for luck: it is
        // far above what noise adds to the error, and would else narrow kernels without a reason.
        const double of_luck = 2.0 * step.variance;
        const double shown = std::max(0.0, step.bias_square - of_luck) / square(step.area);
        const double brighter =
            step.flux > 0.0 ? std::max(1.0, at_points / step.irradiance()) : 1.0;
        bound = std::min(0.5 * bound, square(brighter) * shown);
        // A kernel without photons is not known to have no noise.
        if (step.flux > 0.0) of_a_photon = step.variance / step.flux;
        const double variance =
            std::max(0.5 * square(of_a_photon), step.variance) / square(step.area);
        // Less one standard deviation of a product of moments, if photons are random.
        const double lucky_step = std::numbers::sqrt2 / 4.0 * step.variance;
        const double of_step = std::max(0.0, step.step_square - lucky_step) *
                               square(share_of_steps * error_per_moment / step.area);
        const double bias =
            std::max(0.0, bound + of_step - square(small_bias * accuracy * at_points));
        const double error = weight_of_noise * variance + bias;
        if (error < least) {
            least = error;
            best_m = radius_m;
        }
        radius_m /= std::numbers::sqrt2;
    }
    return best_m;
}

std::vector<std::vector<Arrival>> arrivals_by_patch(const Stage& stage, const SensorPlanes& planes,
                                                    const PilotPhotons& pilot) {
    std::vector<std::vector<Arrival>> arrivals(stage.patch_count() + planes.count());
    for (const Photon& photon : pilot.photons) {
        arrivals[kernel_patch(stage, photon.point)].push_back(
            {photon.point.position, static_cast<double>(photon.flux.sum())});
    }
    for (auto& of_patch : arrivals) normalise(of_patch);
    return arrivals;
}

// No kernel of a patch is wider.
double limit_of_patch_m(const Stage& stage, const SensorPlanes& planes, std::uint32_t patch) {
    return patch >= stage.patch_count() ? planes.margin_m()
                                        : std::min(stage.caster().scene_radius_m() / 20.0,
                                                   std::sqrt(stage.patch_area_m2(patch)) / 8.0);
}

// @param photons  of the pilot trace in a kernel; what surfaces and sensors ask for comes on top.
Radii radii_of(const Stage& stage, const SensorPlanes& planes, const PilotPhotons& pilot,
               const PhotonsPerKernel& photons, bool seen) {
    const auto arrivals = arrivals_by_patch(stage, planes, pilot);
    std::vector<double> radii_m;
    radii_m.reserve(arrivals.size());
    for (std::uint32_t patch = 0; patch < arrivals.size(); ++patch) {
        const bool sensor = patch >= stage.patch_count();
        const double limit_m = limit_of_patch_m(stage, planes, patch);
        double radius_m = limit_m;
        const double photons_per_kernel = sensor ? photons.of_sensors : photons.of_surfaces;
        if (arrivals[patch].size() > 2 * neighbours && photons_per_kernel < infinity) {
            // n photons within d: density n / (pi d^2); wanted K = density * pi r^2.
            const double square_m2 = median_square_distance(arrivals[patch]);
            radius_m = std::min(limit_m, std::sqrt(photons_per_kernel * square_m2 / neighbours));
        }
        if (seen && !sensor && arrivals[patch].size() > 2 * neighbours) {
            std::vector<Vec3> points;
            for (const Arrival& photon : arrivals[patch]) points.push_back(photon.position);
            radius_m = radius_of_small_bias(arrivals[patch], points, radius_m);
        }
        radii_m.push_back(radius_m);
    }
    return Radii(std::move(radii_m));
}

}  // namespace

Radii Radii::at_phase(std::uint32_t number) const {
    constexpr double alpha = 4.0 / 5.0;
    const double factor = std::pow(static_cast<double>(number) + 1.0, (alpha - 1.0) / 2.0);
    Radii shrunk = *this;
    for (double& radius : shrunk.radii_m_) radius *= factor;
    for (double& radius : shrunk.of_points_m_) radius *= factor;
    return shrunk;
}

Radii narrow_radii(const Stage& stage, const SensorPlanes& planes, const PilotPhotons& pilot,
                   const PhotonsPerKernel& photons, std::uint32_t rays, bool seen) {
    const double share = static_cast<double>(pilot.rays) / rays;
    return radii_of(stage, planes, pilot, {share * photons.of_surfaces, share * photons.of_sensors},
                    seen);
}

Radii wide_radii(const Stage& stage, const SensorPlanes& planes, const PilotPhotons& pilot) {
    return radii_of(stage, planes, pilot, {infinity, infinity}, true);
}

Radii widened_around(const Stage& stage, const SensorPlanes& planes, const Radii& radii,
                     const PilotPhotons& one, const PilotPhotons& other,
                     std::span<const ReadPoint> points, double accuracy) {
    const auto of_one = arrivals_by_patch(stage, planes, one);
    const auto of_other = arrivals_by_patch(stage, planes, other);
    std::vector<double> widened;
    for (std::uint32_t patch = 0; patch < of_one.size(); ++patch) widened.push_back(radii[patch]);
    // They had few photons, and may have half of that radius where wider ones are biased.
    constexpr double least = 0.5;
    const auto of_least_error = [&](std::uint32_t patch, const std::vector<Vec3>& positions,
                                    double limit_m) {
        const double radius_m =
            radius_of_least_error(of_one[patch], of_other[patch], positions, limit_m, accuracy);
        return radius_m > 0.0 ? std::max(least * radii[patch], radius_m) : radii[patch];
    };
    // No kernel reaches the wall beside its point, so that the search starts there.
    std::vector<double> clearances_m(planes.point_count());
    for (std::uint32_t plane = 0; plane < planes.count(); ++plane) {
        for (const auto& point : planes.points_of(plane)) {
            clearances_m[point.index] = point.clearance_m;
        }
    }
    std::vector<double> of_points(planes.point_count(), infinity);
    std::vector<std::vector<Vec3>> on_surfaces(stage.patch_count());
    for (const ReadPoint& read : points) {
        const std::uint32_t patch = kernel_patch(stage, read.point);
        if (patch < stage.patch_count()) {
            on_surfaces[patch].push_back(read.point.position);
            continue;
        }
        of_points[read.sensor_point] =
            of_least_error(patch, {read.point.position}, clearances_m[read.sensor_point]);
        widened[patch] = std::max(widened[patch], of_points[read.sensor_point]);
    }
    for (std::uint32_t patch = 0; patch < stage.patch_count(); ++patch) {
        if (!on_surfaces[patch].empty())
            widened[patch] =
                of_least_error(patch, on_surfaces[patch], limit_of_patch_m(stage, planes, patch));
    }
    return Radii(std::move(widened), std::move(of_points));
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
