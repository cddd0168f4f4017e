#include "light_checks.h"
#include "optics/light/intensity_distribution.h"

using namespace lucerna;
using namespace lucerna::test;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;
using optics::IntensityDistribution;

namespace {

// Uneven grid, no symmetry, with dark cells.
IntensityDistribution uneven() {
    return IntensityDistribution(
        {0, 30, 100, 220, 360}, {10, 25, 60, 90, 150},
        {{5, 3, 8, 1, 0}, {2, 9, 0, 0, 0}, {7, 1, 0, 0, 3}, {0, 4, 6, 2, 2}, {5, 3, 8, 1, 0}});
}

// Midpoint rule in angles, independent of the closed form; parts per degree divide the grid.
double flux_by_midpoints(const IntensityDistribution& distribution, int per_degree) {
    const double step = 1.0 / per_degree;
    double sum = 0.0;
    for (int g = 0; g < 180 * per_degree; ++g) {
        const double gamma = (g + 0.5) * step;
        double ring = 0.0;
        for (int c = 0; c < 360 * per_degree; ++c) {
            ring += distribution.intensity_cd(
                IntensityDistribution::direction((c + 0.5) * step, gamma));
        }
        sum += ring * std::sin(gamma * rad_per_deg);
    }
    return sum * step * step * rad_per_deg * rad_per_deg;
}

}  // namespace

TEST_CASE("The flux of simple distributions is that of the closed form", "[light][analytic]") {
    const IntensityDistribution isotropic({0}, {0, 180}, {{2.5, 2.5}});
    CHECK_THAT(isotropic.luminous_flux_lm(), WithinRel(4.0 * pi * 2.5, 1e-14));
    CHECK_THAT(isotropic.zonal_flux_lm(0.0, 90.0), WithinRel(2.0 * pi * 2.5, 1e-14));
    CHECK_THAT(isotropic.zonal_flux_lm(30.0, 60.0),
               WithinRel(2.0 * pi * 2.5 * (std::cos(pi / 6) - std::cos(pi / 3)), 1e-13));

    // I = I0 gamma: integral of gamma sin gamma from 0 to pi/2 is 1.
    const IntensityDistribution linear({0}, {0, 90}, {{0, 90}});
    CHECK_THAT(linear.luminous_flux_lm(), WithinRel(2.0 * pi * 90.0 / (pi / 2.0), 1e-14));

    // A cosine in steps of 1 deg: pi I0 up to the error of interpolation, h^2 / 12 of it.
    std::vector<double> gamma;
    std::vector<double> cosine;
    for (int g = 0; g <= 90; ++g) {
        gamma.push_back(g);
        cosine.push_back(100.0 * std::max(0.0, std::cos(g * rad_per_deg)));
    }
    const IntensityDistribution lambertian({0}, gamma, {cosine});
    CHECK_THAT(lambertian.luminous_flux_lm(), WithinRel(100.0 * pi, 3e-5));
}

TEST_CASE("The flux of an uneven grid is that of a quadrature of its own interpolant",
          "[light][analytic]") {
    const IntensityDistribution distribution = uneven();
    // The midpoint rule in steps of 1/4 deg has an error of about h^2 / 24 = 1e-6.
    CHECK_THAT(distribution.luminous_flux_lm(),
               WithinRel(flux_by_midpoints(distribution, 4), 5e-6));
    double zones = 0.0;
    for (int g = 0; g < 180; g += 20) zones += distribution.zonal_flux_lm(g, g + 20);
    CHECK_THAT(zones, WithinRel(distribution.luminous_flux_lm(), 1e-13));
}

TEST_CASE("Intensities are interpolated in the angles, and zero outside", "[light][unit]") {
    const IntensityDistribution d = uneven();
    const auto at = [&](double c, double gamma) {
        return d.intensity_cd(IntensityDistribution::direction(c, gamma));
    };
    CHECK_THAT(at(100, 25), WithinRel(1.0, 1e-12));
    CHECK_THAT(at(160, 25), WithinRel(2.5, 1e-12));                       // half way from 1 to 4
    CHECK_THAT(at(290, 42.5), WithinRel(0.25 * (4 + 6 + 3 + 8), 1e-12));  // middle of a cell
    CHECK(at(290, 9.9) == 0.0);
    CHECK(at(290, 150.1) == 0.0);
    CHECK_THAT(at(359.999999, 25), WithinRel(3.0, 1e-6));
    CHECK(d.max_intensity_cd() == 9.0);
    CHECK(d.max_c_deg() == 30.0);
    CHECK(d.max_gamma_deg() == 25.0);
    // C = 0 is +x, C = 90 is +y, gamma = 0 is -z.
    CHECK((IntensityDistribution::direction(0, 90) - Vec3::UnitX()).norm() < 1e-15);
    CHECK((IntensityDistribution::direction(90, 90) - Vec3::UnitY()).norm() < 1e-15);
    CHECK((IntensityDistribution::direction(123, 0) + Vec3::UnitZ()).norm() < 1e-15);
}

TEST_CASE("Sampled directions follow the intensity", "[light][statistical]") {
    const IntensityDistribution d = uneven();
    constexpr int columns = 36;
    constexpr int rows = 28;
    constexpr int fine = 20;  // midpoints per bin and angle; quadrature error 1e-4 of a bin
    const double width = 360.0 / columns;
    const double height = 140.0 / rows;
    const auto expected_counts = [&](std::uint32_t n, bool with_sine) {
        std::vector<double> expected(columns * rows);
        double total = 0.0;
        for (int bin = 0; bin < columns * rows; ++bin) {
            double sum = 0.0;
            for (int i = 0; i < fine * fine; ++i) {
                const double c = (bin % columns + (i % fine + 0.5) / fine) * width;
                const double gamma = 10.0 + (bin / columns + (i / fine + 0.5) / fine) * height;
                sum += d.pdf_solid_angle(IntensityDistribution::direction(c, gamma)) *
                       (with_sine ? std::sin(gamma * rad_per_deg) : 1.0);
            }
            expected[static_cast<std::size_t>(bin)] = sum;
            total += sum;
        }
        for (double& value : expected) value *= n / total;
        return expected;
    };
    constexpr std::uint32_t n = 1000000;
    std::vector<double> counts(columns * rows);
    bool dark = false;
    for (std::uint32_t i = 0; i < n; ++i) {
        const auto u = uniforms(i);
        const Vec3 w = d.sample(u[0], u[1]);
        dark = dark || d.pdf_solid_angle(w) <= 0.0;
        const double gamma = std::acos(-w.z()) / rad_per_deg;
        double c = std::atan2(w.y(), w.x()) / rad_per_deg;
        if (c < 0.0) c += 360.0;
        const int column = std::min(columns - 1, static_cast<int>(c / width));
        const int row = std::clamp(static_cast<int>((gamma - 10.0) / height), 0, rows - 1);
        counts[static_cast<std::size_t>(row * columns + column)] += 1.0;
    }
    CHECK_FALSE(dark);
    const std::vector<double> expected = expected_counts(n, true);
    check_follows(counts, expected);
    check_refutes(counts, expected, expected_counts(n, false));
}

TEST_CASE("A needle beam in a fine grid keeps its flux and its directions", "[light][property]") {
    std::vector<double> gamma;
    std::vector<double> beam;
    for (int i = 0; i <= 1800; ++i) {
        gamma.push_back(0.1 * i);
        beam.push_back(i <= 2 ? 1e6 : 0.0);
    }
    gamma.back() = 180.0;
    const IntensityDistribution d({0}, gamma, {beam});
    // Flat to 0.2 deg, then linear down to 0.3 deg; in the plane approximation of small angles the
    // integral of r is 0.2^2/2 + (0.2 * 0.1 / 2 + 0.1^2 / 6).
    const double plane = 0.02 + 0.01 + 0.01 / 6.0;
    CHECK_THAT(d.luminous_flux_lm(),
               WithinRel(1e6 * 2.0 * pi * plane * rad_per_deg * rad_per_deg, 1e-5));
    for (std::uint32_t i = 0; i < 1000; ++i) {
        const auto u = uniforms(i);
        CHECK(-d.sample(u[0], u[1]).z() >= std::cos(0.3 * rad_per_deg) - 1e-15);
    }
}

TEST_CASE("Tables that are no distribution are refused", "[light][unit]") {
    using Table = std::vector<std::vector<double>>;
    const double nan = std::nan("");
    CHECK_THROWS_AS(IntensityDistribution({0}, {0, 90}, Table{{0, 0}}), std::invalid_argument);
    CHECK_THROWS_AS(IntensityDistribution({0}, {0, 90}, Table{{1, -1}}), std::invalid_argument);
    CHECK_THROWS_AS(IntensityDistribution({0}, {0, 90}, Table{{1, nan}}), std::invalid_argument);
    CHECK_THROWS_AS(IntensityDistribution({0}, {0, 0}, Table{{1, 1}}), std::invalid_argument);
    CHECK_THROWS_AS(IntensityDistribution({0}, {0, 190}, Table{{1, 1}}), std::invalid_argument);
    CHECK_THROWS_AS(IntensityDistribution({0}, {45}, Table{{1}}), std::invalid_argument);
    CHECK_THROWS_AS(IntensityDistribution({0, 350}, {0, 90}, Table{{1, 1}, {1, 1}}),
                    std::invalid_argument);
    CHECK_THROWS_AS(IntensityDistribution({0, 360}, {0, 90}, Table{{1, 1}}), std::invalid_argument);
}
