#include "spectral/colorimetry.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

#include "spectral/illuminants.h"
#include "spectral/integral.h"
#include "spectral/observer.h"

namespace lucerna::spectral {
namespace {

// The locus is searched in reciprocal temperature, in which its points lie nearly evenly.
constexpr double min_mired = 10.0;    // 100 000 K
constexpr double max_mired = 1000.0;  // 1000 K
constexpr double max_duv = 0.05;      // limit of meaning by CIE 15:2018

double temperature_k(double mired) {
    return 1e6 / mired;
}

// A sum over the nodes that the observer and planck() share, as CIE 15:2018 recommends.
UniformChromaticity black_body_1960(double mired) {
    const std::vector<double> radiance = planck(temperature_k(mired)).values();
    const auto sum = [&](const Spectrum& observer) {
        return std::inner_product(radiance.begin(), radiance.end(), observer.values().begin(), 0.0);
    };
    return *chromaticity_1960({sum(x_bar()), sum(v_lambda()), sum(z_bar())});
}

double distance(UniformChromaticity a, UniformChromaticity b) {
    return std::hypot(a.u - b.u, a.v - b.v);
}

// Points of the locus, so dense that cubic interpolation is exact to 1e-10, from one step before
// the range of the search to one step beyond it.
constexpr double mired_step = 2.0;
const std::vector<UniformChromaticity>& locus() {
    static const std::vector<UniformChromaticity> points = [] {
        std::vector<UniformChromaticity> list;
        for (double mired = min_mired - mired_step; mired < max_mired + 1.5 * mired_step;
             mired += mired_step) {
            list.push_back(black_body_1960(mired));
        }
        return list;
    }();
    return points;
}

// By Lagrange's polynomial through four points of the locus.
UniformChromaticity on_locus(double mired) {
    const std::vector<UniformChromaticity>& points = locus();
    const double place = (mired - min_mired) / mired_step;
    const auto first = static_cast<std::size_t>(
        std::clamp(std::floor(place), 0.0, static_cast<double>(points.size() - 4)));
    const double t = place - static_cast<double>(first);
    const std::array<double, 4> weights{
        -t * (t - 1.0) * (t - 2.0) / 6.0, (t + 1.0) * (t - 1.0) * (t - 2.0) / 2.0,
        -(t + 1.0) * t * (t - 2.0) / 2.0, (t + 1.0) * t * (t - 1.0) / 6.0};
    UniformChromaticity sum{0.0, 0.0};
    for (std::size_t i = 0; i < weights.size(); ++i) {
        sum.u += weights[i] * points[first + i].u;
        sum.v += weights[i] * points[first + i].v;
    }
    return sum;
}

// Golden section search for the minimum of a function with one minimum in the interval.
template <typename Function>
double minimum(const Function& function, double low, double high, double tolerance) {
    const double golden = (std::sqrt(5.0) - 1.0) / 2.0;
    double left = high - golden * (high - low);
    double right = low + golden * (high - low);
    double at_left = function(left);
    double at_right = function(right);
    while (high - low > tolerance) {
        if (at_left < at_right) {
            high = right;
            right = left;
            at_right = at_left;
            left = high - golden * (high - low);
            at_left = function(left);
        } else {
            low = left;
            left = right;
            at_left = at_right;
            right = low + golden * (high - low);
            at_right = function(right);
        }
    }
    return 0.5 * (low + high);
}

}  // namespace

Xyz tristimulus(const Spectrum& spectral) {
    constexpr double k_m = max_luminous_efficacy_lm_per_w;
    return {k_m * integral_of_product(spectral, x_bar()),
            k_m * integral_of_product(spectral, v_lambda()),
            k_m * integral_of_product(spectral, z_bar())};
}

std::optional<Chromaticity> chromaticity(const Xyz& colour) {
    const double sum = colour.x + colour.y + colour.z;
    if (!(sum > 0.0)) return std::nullopt;
    return Chromaticity{colour.x / sum, colour.y / sum};
}

std::optional<UniformChromaticity> chromaticity_1976(const Xyz& colour) {
    const double sum = colour.x + 15.0 * colour.y + 3.0 * colour.z;
    if (!(sum > 0.0)) return std::nullopt;
    return UniformChromaticity{4.0 * colour.x / sum, 9.0 * colour.y / sum};
}

std::optional<UniformChromaticity> chromaticity_1960(const Xyz& colour) {
    std::optional<UniformChromaticity> uv = chromaticity_1976(colour);
    if (uv) uv->v *= 2.0 / 3.0;
    return uv;
}

std::optional<ColourTemperature> correlated_colour_temperature(const Xyz& colour) {
    const std::optional<UniformChromaticity> uv = chromaticity_1960(colour);
    if (!uv) return std::nullopt;

    const auto distance_to = [&](double mired) { return distance(*uv, on_locus(mired)); };
    // Dense enough to enclose the one minimum between neighbours of the nearest.
    constexpr double coarse_step = 10.0;
    double nearest = min_mired;
    for (double mired = min_mired; mired <= max_mired; mired += coarse_step) {
        if (distance_to(mired) < distance_to(nearest)) nearest = mired;
    }
    const double mired = minimum(distance_to, std::max(min_mired, nearest - coarse_step),
                                 std::min(max_mired, nearest + coarse_step), 1e-6);
    const double duv = distance_to(mired);
    const bool at_an_end = mired < min_mired + 1e-3 || mired > max_mired - 1e-3;
    if (at_an_end || duv > max_duv) return std::nullopt;
    return ColourTemperature{temperature_k(mired), std::copysign(duv, uv->v - on_locus(mired).v)};
}

const Eigen::Matrix3d& linear_srgb_from_xyz() {
    static const Eigen::Matrix3d matrix = [] {
        const auto direction = [](double x, double y) {
            return Eigen::Vector3d(x / y, 1.0, (1.0 - x - y) / y);
        };
        Eigen::Matrix3d primaries;
        primaries.col(0) = direction(0.64, 0.33);
        primaries.col(1) = direction(0.30, 0.60);
        primaries.col(2) = direction(0.15, 0.06);
        const Eigen::Vector3d luminances = primaries.inverse() * direction(0.3127, 0.3290);
        return Eigen::Matrix3d((primaries * luminances.asDiagonal()).inverse());
    }();
    return matrix;
}

}  // namespace lucerna::spectral
