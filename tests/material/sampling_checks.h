// What every scattering BSDF owes to its sampler: a density that integrates to the probability of
// scattering, samples that follow it, and weights whose mean is the albedo.
#pragma once

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "core/random.h"
#include "surface_fixture.h"
#include "tests/support/check_mean.h"

namespace lucerna::test {

using optics::BsdfSample;
using optics::Transport;

/// Composite Gauss rule with three points: nodes and weights on [0, 1], divided into equal parts.
inline std::vector<std::pair<double, double>> gauss_rule(int parts) {
    std::vector<std::pair<double, double>> rule;
    for (int i = 0; i < parts; ++i) {
        for (const auto& [x, w] :
             {std::pair(0.5 - std::sqrt(0.15), 5.0 / 18.0), std::pair(0.5, 8.0 / 18.0),
              std::pair(0.5 + std::sqrt(0.15), 5.0 / 18.0)}) {
            rule.emplace_back((i + x) / parts, w / parts);
        }
    }
    return rule;
}

/// Calls add(direction, solid angle, theta node, phi node) for a quadrature of the sphere.
template <typename Add>
void over_sphere(int theta_parts, int phi_parts, Add add) {
    const auto thetas = gauss_rule(theta_parts), phis = gauss_rule(phi_parts);
    for (std::size_t t = 0; t < thetas.size(); ++t) {
        const double theta = pi * thetas[t].first;
        for (std::size_t p = 0; p < phis.size(); ++p) {
            const double phi = 2.0 * pi * phis[p].first;
            add(Vec3(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                     std::cos(theta)),
                std::sin(theta) * 2.0 * pi * pi * thetas[t].second * phis[p].second, t, p);
        }
    }
}

/// Integral over the sphere of a function of direction; the parts end at the horizon.
template <typename Function>
double sphere_integral(Function value) {
    double sum = 0.0;
    over_sphere(120, 100, [&](const Vec3& w, double solid_angle, std::size_t, std::size_t) {
        sum += value(w) * solid_angle;
    });
    return sum;
}

using Density = std::function<double(const Vec3&)>;
using Sampler = std::function<std::optional<Vec3>(double u_lobe, double u1, double u2)>;

/// Numbers of samples in cells of polar angle (9 deg) and azimuth (18 deg), as expected from a
/// density and as drawn; the last cell is of samples that were absorbed.
struct CellCounts {
    std::vector<double> expected, counted;
    double sample_count;

    /// Pearson's chi-square as a standard normal deviate (Wilson and Hilferty, 1931), with the
    /// density multiplied by `factor`. Cells with fewer than 5 expected samples are merged.
    double chi_square_deviate(double factor = 1.0) const {
        double chi_square = 0.0, merged_expected = 0.0, merged_counted = 0.0, total = 0.0;
        int cells = 0;
        for (std::size_t i = 0; i < expected.size(); ++i) {
            const bool absorbed = i + 1 == expected.size();
            merged_expected +=
                absorbed ? std::max(0.0, sample_count - total) : factor * expected[i];
            total += factor * expected[i];
            merged_counted += counted[i];
            if (merged_expected < 5.0) continue;
            const double difference = merged_counted - merged_expected;
            chi_square += difference * difference / merged_expected;
            merged_expected = merged_counted = 0.0;
            ++cells;
        }
        // What is left has fewer than 5 expected: many samples there are an error of their own.
        if (merged_counted > 40.0 || cells < 2) return infinity;
        const double degrees = cells - 1, spread = 2.0 / (9.0 * degrees);
        return (std::cbrt(chi_square / degrees) - (1.0 - spread)) / std::sqrt(spread);
    }
};

inline CellCounts count_cells(const Sampler& sample, const Density& density, int sample_count) {
    constexpr int theta_cells = 20, phi_cells = 20, parts = 4;
    CellCounts cells{std::vector<double>(theta_cells * phi_cells + 1),
                     std::vector<double>(theta_cells * phi_cells + 1),
                     static_cast<double>(sample_count)};
    over_sphere(theta_cells * parts, phi_cells * parts,
                [&](const Vec3& w, double solid_angle, std::size_t t, std::size_t p) {
                    cells.expected[t / (3 * parts) * phi_cells + p / (3 * parts)] +=
                        density(w) * solid_angle * sample_count;
                });
    RandomStream random(7, 0, RandomPurpose::test, 1);
    for (int i = 0; i < sample_count; ++i) {
        const double u_lobe = random.uniform(), u1 = random.uniform(), u2 = random.uniform();
        const std::optional<Vec3> w = sample(u_lobe, u1, u2);
        if (!w) {
            cells.counted.back() += 1.0;
            continue;
        }
        const double turns = std::atan2(w->y(), w->x()) / (2.0 * pi);
        const double theta = std::acos(std::clamp(w->z(), -1.0, 1.0));
        const int t = std::min(theta_cells - 1, static_cast<int>(theta / pi * theta_cells));
        const int p = std::min(phi_cells - 1,
                               static_cast<int>((turns < 0.0 ? turns + 1.0 : turns) * phi_cells));
        cells.counted[static_cast<std::size_t>(t * phi_cells + p)] += 1.0;
    }
    return cells;
}

/// A chi-square deviate beyond this has a chance of 1e-6 if the sampler is right.
inline constexpr double chi_square_limit = 4.753;

inline Sampler sampler_of(const Surface& surface, const Vec3& wo, Transport transport) {
    return [=, &surface](double u_lobe, double u1, double u2) -> std::optional<Vec3> {
        const auto event =
            optics::sample(surface.bsdf(), surface.at(), wo, u_lobe, u1, u2, transport);
        return event ? std::optional(event->wi) : std::nullopt;
    };
}

inline Density density_of(const Surface& surface, const Vec3& wo, Transport transport) {
    return [=, &surface](const Vec3& wi) {
        return optics::pdf_solid_angle(surface.bsdf(), surface.at(), wo, wi, transport);
    };
}

/// Mean and standard error of the weight of each lane.
struct MeanWeight {
    Eigen::Array<double, spectral::lane_count, 1> mean, standard_error;
};

inline MeanWeight mean_weight(const Surface& surface, const Vec3& wo, Transport transport,
                              int sample_count) {
    RandomStream random(11, 0, RandomPurpose::test, 2);
    Eigen::Array<double, spectral::lane_count, 1> sum, squares;
    sum.setZero();
    squares.setZero();
    for (int i = 0; i < sample_count; ++i) {
        const double u_lobe = random.uniform(), u1 = random.uniform(), u2 = random.uniform();
        const auto event =
            optics::sample(surface.bsdf(), surface.at(), wo, u_lobe, u1, u2, transport);
        if (!event) continue;
        sum += event->weight.cast<double>();
        squares += event->weight.cast<double>().square();
    }
    sum /= sample_count;
    return {sum, ((squares / sample_count - sum.square()) / (sample_count - 1)).sqrt()};
}

/// Albedo of each lane by quadrature of f |cos|.
inline Eigen::Array<double, spectral::lane_count, 1> quadrature_albedo(const Surface& surface,
                                                                       const Vec3& wo,
                                                                       Transport transport) {
    Eigen::Array<double, spectral::lane_count, 1> sum;
    sum.setZero();
    over_sphere(100, 80, [&](const Vec3& wi, double solid_angle, std::size_t, std::size_t) {
        sum += optics::evaluate(surface.bsdf(), surface.at(), wo, wi, transport).cast<double>() *
               (std::abs(wi.z()) * solid_angle);
    });
    return sum;
}

/// All three, for one direction.
inline void check_sampler(const Surface& surface, const Vec3& wo, Transport transport) {
    INFO("wo " << wo.transpose() << (transport == Transport::radiance ? ", radiance" : ", flux"));
    const CellCounts cells =
        count_cells(sampler_of(surface, wo, transport), density_of(surface, wo, transport), 80'000);
    CHECK(cells.chi_square_deviate() < chi_square_limit);
    // Twin: a density that is 5 % too large is found (1 % needs 25 times the samples).
    CHECK(cells.chi_square_deviate(1.05) > chi_square_limit);
    const MeanWeight weight = mean_weight(surface, wo, transport, 200'000);
    const auto albedo = quadrature_albedo(surface, wo, transport);
    for (const int lane : {surface.wavelengths.hero, 12}) {
        if (surface.hero_only && lane != surface.wavelengths.hero) continue;
        INFO("lane " << lane);
        // The quadrature is good to 1e-3 for the narrowest lobes here.
        check_mean(weight.mean[lane], weight.standard_error[lane], albedo[lane],
                   DetectsRelative{0.025}, 1e-3 * albedo[lane]);
    }
}

}  // namespace lucerna::test
