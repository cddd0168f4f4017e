#include "optics/transport/sensor_radii.h"

#include <algorithm>
#include <numbers>

#include "core/parallel.h"
#include "optics/transport/forward_map.h"
#include "optics/transport/pilot_light.h"

namespace lucerna::optics {
namespace {

// In standard deviations of a product of two measurements if photons are random: what is taken for
// luck, from where on a bias or step is sure, and beyond doubt even of many narrow kernels.
constexpr double luck = 0.5, sure = 2.0, beyond_doubt = 5.0;

// What kernels of one radius hold, in the mean over the points.
struct Step {
    double area = 0.0;         // of the kernel, over that of the widest
    double flux = 0.0;         // of a pilot
    double variance = 0.0;     // of that flux
    double bias_square = 0.0;  // of that flux
    double step_square = 0.0;  // of its moment of a step over its radius
    double irradiance() const { return flux / area; }
};

// Two independent measurements of a bias have its square as the expectation of their product,
// whatever their noise. That is told by the photons of the place: where rays are guided, those
// elsewhere may be a thousand times as heavy.
std::vector<Step> steps_of_radius(const std::vector<Arrival>& one,
                                  const std::vector<Arrival>& other,
                                  const std::vector<Vec3>& points, double limit_m, int threads) {
    // Light with much structure at once has steps that point away from where it is brighter.
    constexpr double step_left_if_away = 0.5;
    std::vector<Step> steps(LightByRadius::steps);
    for (std::size_t i = 0; i < steps.size(); ++i) {
        steps[i].area = std::ldexp(1.0, -static_cast<int>(i));
    }
    const double share = 1.0 / static_cast<double>(points.size());
    const auto of_one = LightByRadius::around(points, one, limit_m, threads);
    const auto of_other = LightByRadius::around(points, other, limit_m, threads);
    for (std::size_t point = 0; point < points.size(); ++point) {
        const LightByRadius& a = of_one[point];
        const LightByRadius& b = of_other[point];
        for (std::size_t i = 0; i < steps.size(); ++i) {
            steps[i].flux += 0.5 * share * (a.flux[i] + b.flux[i]);
            steps[i].variance += 0.5 * share * (a.squares[i] + b.squares[i]);
            steps[i].bias_square +=
                share * 4.0 * (a.flux[i] - 2.0 * a.flux[i + 1]) * (b.flux[i] - 2.0 * b.flux[i + 1]);
            const Vec3 of_a = a.moment_of_step(i), of_b = b.moment_of_step(i);
            const bool away = (of_a + of_b).dot(a.moment[i] + b.moment[i]) < 0.0;
            steps[i].step_square +=
                share * (away ? square(step_left_if_away) : 1.0) * of_a.dot(of_b) / steps[i].area;
        }
    }
    return steps;
}

// As the narrowest kernels tell it that hold enough photons.
double irradiance_at_points(const std::vector<Step>& steps) {
    constexpr double enough_photons = 8.0;  // of equal flux
    double irradiance = 0.0;
    for (const Step& step : steps) {
        if (square(step.flux) > enough_photons * step.variance) irradiance = step.irradiance();
    }
    return irradiance;
}

// Squares of what enters U of the irradiance at the points.
struct Error {
    double noise_square;  // of a phase
    double bias_square;   // Estimate::bias_left() and StepBias
};

// Narrow kernels tell little of the bias; but it falls with the radius at least as fast as beside a
// kink, in proportion, so that what a wide kernel shows bounds the narrower ones, unless they
// surely show more. A step shows by its moment, and is not expected where it does not.
//
// All errors are those of the irradiance at the points, not in shares of what a kernel holds: a
// wide one beside bright light would be favoured for having much of that. Where the points are
// brighter than what lies around, it is their own irradiance that a bias is a share of.
std::vector<Error> errors_of(const std::vector<Step>& steps, double at_points,
                             double pilots_per_phase) {
    constexpr double expansion = 1.96;  // to 95 %
    constexpr double bias_left = 0.5;
    // Of the narrow kernel over that of the even one: the mean of the square of its weights.
    constexpr double variance_of_correction = 4.8;
    std::vector<Error> errors;
    double bound = infinity;   // of the square of the bias
    double of_a_photon = 0.0;  // flux
    for (const Step& step : steps) {
        const double brighter =
            step.flux > 0.0 ? std::max(1.0, at_points / step.irradiance()) : 1.0;
        const double per_flux = square(brighter / step.area);
        // A bias is a sum of photons with weights of 2 and -2.
        const double deviation = 4.0 * step.variance;
        const double shown = std::max(0.0, step.bias_square);
        bound = std::max(std::min(0.5 * bound, per_flux * (shown + luck * deviation)),
                         per_flux * (shown - sure * deviation));
        // Mean of x^2 (1 - 3/2 x^2)^2 over the disc: 1 / 32 along each of two axes.
        const double deviation_of_step = std::numbers::sqrt2 / 32.0 * step.variance;
        const double of_step = std::max(0.0, step.step_square - sure * deviation_of_step) *
                               square(bias_per_moment_of_step / step.area);
        // A kernel without photons is not known to have no noise.
        if (step.flux > 0.0) of_a_photon = step.variance / step.flux;
        const double variance =
            std::max(0.5 * square(of_a_photon), step.variance) / square(step.area);
        errors.push_back({square(expansion) * variance_of_correction * pilots_per_phase * variance,
                          std::max(square(bias_left) * bound, of_step)});
        // An edge on two sides and a hollow on the others may hide each other in a wide kernel.
        const double hidden = square(bias_left) * per_flux * (shown - beyond_doubt * deviation);
        for (std::size_t wider = 2; wider <= 3 && wider <= errors.size(); ++wider) {
            double& bias_square = errors[errors.size() - wider].bias_square;
            bias_square = std::max(bias_square, hidden);
        }
    }
    return errors;
}

// The radius of least error at the points after as many phases as it takes to know them to the
// accuracy; without photons the widest, which finds rare ones soonest.
// @param pilots_per_phase  rays of a pilot over those of a phase.
double radius_of_least_error(const std::vector<Arrival>& one, const std::vector<Arrival>& other,
                             const std::vector<Vec3>& points, double limit_m, double accuracy,
                             double pilots_per_phase, int threads) {
    // Runs look first after 16 phases, and stop at the second look; far beyond the most it is time
    // that ends them.
    constexpr double least_phases = 19.0, most_phases = 256.0;
    const std::vector<Step> steps = steps_of_radius(one, other, points, limit_m, threads);
    if (!(steps[0].flux > 0.0)) return limit_m;
    const double at_points = irradiance_at_points(steps);
    const double asked_square = square(accuracy * at_points);
    const std::vector<Error> errors = errors_of(steps, at_points, pilots_per_phase);
    double phases = most_phases;
    for (const Error& error : errors) {
        if (error.bias_square < asked_square)
            phases = std::min(phases, error.noise_square / (asked_square - error.bias_square));
    }
    phases = std::max(least_phases, phases);
    double best_m = 0.0;
    double least = infinity;
    double radius_m = limit_m;
    for (const Error& error : errors) {
        const double all = error.noise_square / phases + error.bias_square;
        if (all < least) {
            least = all;
            best_m = radius_m;
        }
        radius_m /= std::numbers::sqrt2;
    }
    return best_m;
}

}  // namespace

Radii widened_around(const Stage& stage, const SensorPlanes& planes, const Radii& radii,
                     const PilotPhotons& one, const PilotPhotons& other,
                     std::span<const ReadPoint> points, double accuracy, std::uint32_t rays,
                     int threads) {
    const auto of_one = arrivals_by_patch(stage, planes, one);
    const auto of_other = arrivals_by_patch(stage, planes, other);
    std::vector<double> widened;
    for (std::uint32_t patch = 0; patch < of_one.size(); ++patch) widened.push_back(radii[patch]);
    // They had few photons, and may have half of that radius where wider ones are biased.
    constexpr double least = 0.5;
    const auto of_least_error = [&](std::uint32_t patch, const std::vector<Vec3>& positions,
                                    double limit_m) {
        const double radius_m =
            radius_of_least_error(of_one[patch], of_other[patch], positions, limit_m, accuracy,
                                  static_cast<double>(one.rays) / rays, threads);
        return std::max(least * radii[patch], radius_m);
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
    std::vector<ReadPoint> on_planes;
    for (const ReadPoint& read : points) {
        const std::uint32_t patch = kernel_patch(stage, read.point);
        if (patch < stage.patch_count()) {
            on_surfaces[patch].push_back(read.point.position);
        } else {
            on_planes.push_back(read);
        }
    }
    for_each_block(on_planes.size(), threads, [&](std::size_t i) {
        const ReadPoint& read = on_planes[i];
        of_points[read.sensor_point] =
            of_least_error(kernel_patch(stage, read.point), {read.point.position},
                           clearances_m[read.sensor_point]);
    });
    for (const ReadPoint& read : on_planes) {
        double& of_plane = widened[kernel_patch(stage, read.point)];
        of_plane = std::max(of_plane, of_points[read.sensor_point]);
    }
    for (std::uint32_t patch = 0; patch < stage.patch_count(); ++patch) {
        if (!on_surfaces[patch].empty())
            widened[patch] =
                of_least_error(patch, on_surfaces[patch], limit_of_patch_m(stage, planes, patch));
    }
    return Radii(std::move(widened), std::move(of_points));
}

}  // namespace lucerna::optics
