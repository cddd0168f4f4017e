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
// its first and third moment about the point, in units of the limit.
constexpr std::size_t radius_steps = 32;  // the last is 2e-5 of the first
struct LightByRadius {
    std::array<double, radius_steps + 1> flux{}, squares{};
    std::array<Vec3, radius_steps + 1> moment = zeros(), third_moment = zeros();

    static std::array<Vec3, radius_steps + 1> zeros() {
        std::array<Vec3, radius_steps + 1> vectors;
        vectors.fill(Vec3::Zero());
        return vectors;
    }
    // Sum of flux times x (1 - 3/2 x^2 / r^2), as in kernels: of a step, but not of a slope.
    Vec3 moment_of_step(std::size_t i) const {
        return moment[i] - 1.5 * std::ldexp(1.0, static_cast<int>(i)) * third_moment[i];
    }
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
        light.third_moment[step] += photon.flux * square * way;
    }
    for (std::size_t i = radius_steps; i > 0; --i) {
        light.flux[i - 1] += light.flux[i];
        light.squares[i - 1] += light.squares[i];
        light.moment[i - 1] += light.moment[i];
        light.third_moment[i - 1] += light.third_moment[i];
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

// The radius of least error at the points after as many phases as it takes to know them to the
// accuracy, 0 without photons. Errors are what they add to U: noise, and what the correction of the
// bias leaves (Estimate::bias_left, StepBias).
//
// Two independent measurements of the bias have its square as the expectation of their product,
// whatever their noise. Narrow kernels tell little of it; but it falls with the radius at least as
// fast as beside a kink, in proportion, so that what a wide kernel shows bounds the narrower ones,
// unless they surely show more. A step shows by its moment, and is not expected where it does not.
//
// Noise is told by the photons of the place: where rays are guided, those elsewhere may be a
// thousand times as heavy.
//
// All errors are those of the irradiance at the points, not in shares of what a kernel holds: a
// wide one beside bright light would be favoured for having much of that. Where the points are
// brighter than what lies around, it is their own irradiance that a bias is a share of.
//
// @param pilots_per_phase  rays of a pilot over those of a phase.
double radius_of_least_error(const std::vector<Arrival>& one, const std::vector<Arrival>& other,
                             const std::vector<Vec3>& points, double limit_m, double accuracy,
                             double pilots_per_phase) {
    constexpr double enough_photons = 8.0;  // of equal flux, to tell the irradiance
    constexpr double expansion = 1.96;      // to 95 %
    constexpr double bias_left = 0.5;
    // Light with much structure at once has steps that point away from where it is brighter.
    constexpr double step_left_if_away = 0.5;
    // In standard deviations of a product of two measurements if photons are random: what is taken
    // for luck, and from where on a bias or step is sure.
    constexpr double luck = 0.5, sure = 2.0;
    // Of the narrow kernel over that of the even one: the mean of the square of its weights.
    constexpr double variance_of_correction = 4.8;
    // Runs look first after 16 phases, and stop at the second look; far beyond the most it is time
    // that ends them.
    constexpr double least_phases = 19.0, most_phases = 256.0;
    struct Step {
        double area = 0.0;         // of the kernel, over that of the widest
        double flux = 0.0;         // of one kernel of a point
        double variance = 0.0;     // of that flux
        double bias_square = 0.0;  // of that flux
        double step_square = 0.0;  // of its moment of a step over its radius
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
            const Vec3 of_a = a.moment_of_step(i), of_b = b.moment_of_step(i);
            const bool away = (of_a + of_b).dot(a.moment[i] + b.moment[i]) < 0.0;
            steps[i].step_square +=
                share * (away ? square(step_left_if_away) : 1.0) * of_a.dot(of_b) / steps[i].area;
        }
    }
    if (!(steps[0].flux > 0.0)) return 0.0;
    double at_points = 0.0;
    for (const Step& step : steps) {
        if (square(step.flux) > enough_photons * step.variance) at_points = step.irradiance();
    }
    struct Error {
        double noise_square;  // of a phase, expanded
        double bias_square;
    };
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
    }
    const double asked_square = square(accuracy * at_points);
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
                     std::span<const ReadPoint> points, double accuracy, std::uint32_t rays) {
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
                                  static_cast<double>(one.rays) / rays);
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
