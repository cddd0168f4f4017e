// What every scattering BSDF owes to its sampler: a density that integrates to the probability of
// scattering, samples that follow it, and weights whose mean is the albedo.
#pragma once

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "core/random.h"
#include "surface_fixture.h"
#include "tests/support/check_mean.h"
#include "tests/support/chi_square.h"
#include "tests/support/direction_cells.h"

namespace lucerna::test {

using optics::BsdfSample;
using optics::Transport;

/// Calls add(direction, solid angle, theta node, phi node) for a quadrature of the sphere.
template <typename Add>
void over_sphere(int theta_parts, int phi_parts, Add add) {
    over_cone(pi, theta_parts, phi_parts, add);
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

inline DirectionSampler sampler_of(const Surface& surface, const Vec3& wo, Transport transport) {
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

/// event_split() states the integral of the density over the side of wo, and the u_lobe
/// below it reflect.
inline void check_sides(const Surface& surface, const Vec3& wo, Transport transport) {
    const optics::EventSplit split =
        optics::event_split(surface.bsdf(), surface.at(), wo, transport);
    REQUIRE(split.by_side);
    const double reflected = split.first;
    INFO("probability of reflection " << reflected);
    const Density density = density_of(surface, wo, transport);
    const double integral =
        sphere_integral([&](const Vec3& wi) { return wi.z() * wo.z() > 0.0 ? density(wi) : 0.0; });
    CHECK(std::abs(integral - reflected) < 0.01);
    RandomStream random(12, 0, RandomPurpose::test, 0);
    for (int i = 0; i < 1000; ++i) {
        const double u_lobe = random.uniform(), u1 = random.uniform(), u2 = random.uniform();
        const auto event =
            optics::sample(surface.bsdf(), surface.at(), wo, u_lobe, u1, u2, transport);
        if (!event) FAIL("no sample");
        if ((event->wi.z() * wo.z() > 0.0) != (u_lobe < reflected)) FAIL("u_lobe " << u_lobe);
    }
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
    return {sum, ((squares / sample_count - sum.square()).max(0.0) / (sample_count - 1)).sqrt()};
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
inline void check_sampler(const Surface& surface, const Vec3& wo, Transport transport,
                          int cell_parts = 4, DetectsRelative detects = {0.025}) {
    INFO("wo " << wo.transpose() << (transport == Transport::radiance ? ", radiance" : ", flux"));
    constexpr int samples = 80'000;
    const DirectionCells cells;  // their edges hold the horizon
    const std::vector<double> counts = cells.counts(sampler_of(surface, wo, transport), samples);
    const Density density = density_of(surface, wo, transport);
    const std::vector<double> expected = cells.expected(density, samples, cell_parts);
    check_follows(counts, expected);
    // Twin: a density that is 7 % too large is found (1 % needs 50 times the samples).
    std::vector<double> larger = expected;
    for (double& count : larger) count *= 1.07;
    const double scattered = std::accumulate(larger.begin(), larger.end() - 1, 0.0);
    larger.back() = std::max(0.0, samples - scattered);
    check_refutes(counts, expected, larger);
    const MeanWeight weight = mean_weight(surface, wo, transport, 200'000);
    const auto albedo = quadrature_albedo(surface, wo, transport);
    for (const int lane : {surface.hero, 12}) {
        if (surface.hero_only && lane != surface.hero) continue;
        INFO("lane " << lane);
        // The quadrature is good to 1e-3 for the narrowest lobes here.
        check_mean(weight.mean[lane], weight.standard_error[lane], albedo[lane], detects,
                   1e-3 * albedo[lane]);
    }
}

}  // namespace lucerna::test
