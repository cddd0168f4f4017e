#include "core/sampling.h"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <vector>

#include "core/random.h"
#include "tests/support/chi_square.h"

using namespace lucerna;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

constexpr int sample_count = 200000;

// Chi-square, as a standard normal deviate, of points (a, b) in [0, 1)^2 over 16 x 16 cells, all of
// which must be equally likely.
double equal_cells_deviate(const std::function<std::array<double, 2>(double, double)>& map) {
    std::vector<double> counts(256);
    RandomStream random(21, 0, RandomPurpose::test, 0);
    for (int i = 0; i < sample_count; ++i) {
        const double u1 = random.uniform();
        const double u2 = random.uniform();
        const auto [a, b] = map(u1, u2);
        REQUIRE(a >= 0.0);
        REQUIRE(b >= 0.0);
        const auto cell = [](double x) {
            return static_cast<std::size_t>(std::min(x * 16.0, 15.0));
        };
        counts[cell(a) * 16 + cell(b)] += 1.0;
    }
    return test::chi_square_deviate(counts, std::vector<double>(256, sample_count / 256.0));
}

// Azimuth in [0, 1)
double azimuth(double x, double y) {
    const double turn = std::atan2(y, x) / (2.0 * pi);
    return turn < 0.0 ? turn + 1.0 : turn;
}

}  // namespace

TEST_CASE("Directions on the hemisphere follow the cosine", "[statistical]") {
    // P(theta < t) = sin^2 t for density cos / pi, so that sin^2 theta is uniform.
    CHECK(equal_cells_deviate([](double u1, double u2) {
              const Vec3 d = sample_cosine_hemisphere(u1, u2);
              REQUIRE_THAT(d.norm(), WithinRel(1.0, 1e-12));
              REQUIRE(d.z() >= 0.0);
              return std::array{1.0 - d.z() * d.z(), azimuth(d.x(), d.y())};
          }) < test::chi_square_limit);
    // Twin: without the cosine sin^2 theta is not uniform.
    CHECK(equal_cells_deviate([](double u1, double u2) {
              const Vec3 d = sample_cone(0.0, u1, u2);
              return std::array{1.0 - d.z() * d.z(), azimuth(d.x(), d.y())};
          }) > test::chi_square_limit);
}

TEST_CASE("Directions on the sphere are uniform", "[statistical]") {
    // By Archimedes z is uniform.
    CHECK(equal_cells_deviate([](double u1, double u2) {
              const Vec3 d = sample_sphere(u1, u2);
              REQUIRE_THAT(d.norm(), WithinRel(1.0, 1e-12));
              return std::array{0.5 * (d.z() + 1.0), azimuth(d.x(), d.y())};
          }) < test::chi_square_limit);
    // Twin: equal steps of the polar angle crowd the poles.
    CHECK(equal_cells_deviate([](double u1, double u2) {
              return std::array{0.5 * (std::cos(pi * u1) + 1.0), u2};
          }) > test::chi_square_limit);
}

TEST_CASE("Directions in a cone are uniform, also in a narrow one", "[statistical]") {
    const double half_angle_rad = GENERATE(1e-5, 0.2, 1.5, 2.5);
    // 1 - cos without cancellation, by the test itself
    const double height = 2.0 * std::pow(std::sin(0.5 * half_angle_rad), 2);
    CHECK(equal_cells_deviate([&](double u1, double u2) {
              const Vec3 d = sample_cone(std::cos(half_angle_rad), u1, u2);
              REQUIRE_THAT(d.norm(), WithinRel(1.0, 1e-12));
              const double theta_rad = std::atan2(std::hypot(d.x(), d.y()), d.z());
              const double part = 2.0 * std::pow(std::sin(0.5 * theta_rad), 2) / height;
              REQUIRE(part < 1.0 + 1e-6);
              return std::array{part, azimuth(d.x(), d.y())};
          }) < test::chi_square_limit);
    // Twin: a cone that is 5 % too wide.
    CHECK(equal_cells_deviate([&](double u1, double u2) {
              const Vec3 d = sample_cone(std::cos(1.05 * half_angle_rad), u1, u2);
              const double theta_rad = std::atan2(std::hypot(d.x(), d.y()), d.z());
              const double part = 2.0 * std::pow(std::sin(0.5 * theta_rad), 2) / height;
              return std::array{std::min(part, 1.0), azimuth(d.x(), d.y())};
          }) > test::chi_square_limit);
}

TEST_CASE("Points in the disk are uniform", "[statistical]") {
    CHECK(equal_cells_deviate([](double u1, double u2) {
              const Vec2 p = sample_disk(u1, u2);
              REQUIRE(p.norm() < 1.0 + 1e-12);
              return std::array{p.squaredNorm(), azimuth(p.x(), p.y())};
          }) < test::chi_square_limit);
    // Twin: equal steps of the radius crowd the centre.
    CHECK(equal_cells_deviate([](double u1, double u2) {
              return std::array{u1 * u1, u2};
          }) > test::chi_square_limit);
    CHECK(sample_disk(0.5, 0.5) == Vec2(0.0, 0.0));
}

TEST_CASE("A point of the disk tells the numbers that it was sampled from") {
    for (double u1 = 0.0; u1 < 1.0; u1 += 0.03125) {
        for (double u2 = 0.0; u2 < 1.0; u2 += 0.0312) {
            INFO("u1 " << u1 << ", u2 " << u2);
            const Vec2 point = sample_disk(u1, u2);
            const Vec2 numbers = numbers_of_disk_sample(point);
            REQUIRE((numbers.array() >= 0.0).all());
            REQUIRE((numbers.array() < 1.0).all());
            // On the rim the two numbers of a diagonal meet, so that the point is compared.
            CHECK((sample_disk(numbers.x(), numbers.y()) - point).norm() < 1e-12);
        }
    }
    CHECK((numbers_of_disk_sample(sample_disk(0.3, 0.9)) - Vec2(0.3, 0.9)).norm() < 1e-12);
    CHECK((numbers_of_disk_sample(sample_disk(0.9, 0.4)) - Vec2(0.9, 0.4)).norm() < 1e-12);
}

TEST_CASE("Moments of the samplers are those of their densities", "[statistical]") {
    // E[z] = 2/3 and E[z^2] = 1/2 under cos / pi; E[z^2] = 1/3 on the sphere; E[r^2] = 1/2 in the
    // disk. Stratified 1000 x 1000 midpoints leave less than 1e-5.
    double z = 0.0;
    double z2 = 0.0;
    double sphere_z2 = 0.0;
    double disk_r2 = 0.0;
    const int n = 1000;
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
            const double u1 = (i + 0.5) / n;
            const double u2 = (j + 0.5) / n;
            const double cosine = sample_cosine_hemisphere(u1, u2).z();
            z += cosine / (n * n);
            z2 += cosine * cosine / (n * n);
            sphere_z2 += std::pow(sample_sphere(u1, u2).z(), 2) / (n * n);
            disk_r2 += sample_disk(u1, u2).squaredNorm() / (n * n);
        }
    }
    CHECK_THAT(z, WithinRel(2.0 / 3.0, 1e-4));
    CHECK_THAT(z2, WithinRel(0.5, 1e-5));
    CHECK_THAT(sphere_z2, WithinRel(1.0 / 3.0, 1e-5));
    CHECK_THAT(disk_r2, WithinRel(0.5, 1e-5));
}

TEST_CASE("A discrete distribution follows its weights", "[statistical]") {
    const std::vector<double> weights = {0.0, 1.0, 3.0, 0.0, 0.5, 5.5, 0.0};
    const DiscreteDistribution distribution(weights);
    CHECK(distribution.size() == weights.size());
    CHECK_THAT(distribution.total(), WithinRel(10.0, 1e-15));
    double sum = 0.0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        CHECK_THAT(distribution.probability(i), WithinAbs(weights[i] / 10.0, 1e-15));
        sum += distribution.probability(i);
    }
    CHECK_THAT(sum, WithinRel(1.0, 1e-15));

    std::vector<int> counts(weights.size(), 0);
    const int n = 100000;
    for (int i = 0; i < n; ++i) ++counts[distribution.sample((i + 0.5) / n)];
    for (std::size_t i = 0; i < weights.size(); ++i) {
        CHECK_THAT(counts[i], WithinAbs(n * weights[i] / 10.0, 1.0));
    }
}

TEST_CASE("The rest of a number after a choice is uniform again", "[statistical]") {
    const std::vector<double> weights = {2.0, 0.0, 1.0, 7.0};
    const DiscreteDistribution distribution(weights);
    RandomStream random(3, 0, RandomPurpose::test, 0);
    std::array<std::array<int, 10>, 4> counts{};
    for (int i = 0; i < sample_count; ++i) {
        double rest = -1.0;
        const std::size_t index = distribution.sample(random.uniform(), &rest);
        REQUIRE(rest >= 0.0);
        REQUIRE(rest < 1.0);
        ++counts[index][static_cast<std::size_t>(rest * 10.0)];
    }
    std::vector<double> counted, expected;
    for (const std::size_t index : {0u, 2u, 3u}) {
        counted.insert(counted.end(), counts[index].begin(), counts[index].end());
        expected.insert(expected.end(), 10, sample_count * weights[index] / 100.0);
    }
    test::check_follows(counted, expected);
    CHECK(counts[1] == std::array<int, 10>{});
}

TEST_CASE("A choice never falls on a weight of zero", "[property]") {
    const DiscreteDistribution distribution(std::vector<double>{0.0, 1.0, 0.0, 1.0, 0.0});
    CHECK(distribution.sample(0.0) == 1);
    CHECK(distribution.sample(0.5) == 3);
    CHECK(distribution.sample(std::nextafter(0.5, 0.0)) == 1);
    CHECK(distribution.sample(std::nextafter(1.0, 0.0)) == 3);
    double rest = -1.0;
    const DiscreteDistribution one(std::vector<double>{4.0});
    CHECK(one.sample(0.25, &rest) == 0);
    CHECK(rest == 0.25);
}

TEST_CASE("Weights that are no distribution are refused", "[unit]") {
    const std::vector<double> negative = {1.0, -1.0};
    const std::vector<double> zero = {0.0, 0.0};
    const std::vector<double> undefined = {1.0, std::nan("")};
    const std::vector<double> none;
    CHECK_THROWS_AS(DiscreteDistribution(negative), std::invalid_argument);
    CHECK_THROWS_AS(DiscreteDistribution(zero), std::invalid_argument);
    CHECK_THROWS_AS(DiscreteDistribution(undefined), std::invalid_argument);
    CHECK_THROWS_AS(DiscreteDistribution(none), std::invalid_argument);
}

TEST_CASE("A frame is orthonormal and right-handed for any normal", "[property]") {
    RandomStream random(8, 0, RandomPurpose::test, 0);
    for (int i = 0; i < 1000; ++i) {
        const Vec3 n = i == 0   ? Vec3(0, 0, -1)
                       : i == 1 ? Vec3(0, 0, 1)
                                : sample_sphere(random.uniform(), random.uniform());
        const Frame frame(n);
        CHECK_THAT(frame.tangent.norm(), WithinRel(1.0, 1e-12));
        CHECK_THAT(frame.bitangent.norm(), WithinRel(1.0, 1e-12));
        CHECK_THAT(frame.tangent.dot(n), WithinAbs(0.0, 1e-12));
        CHECK_THAT((frame.tangent.cross(frame.bitangent) - n).norm(), WithinAbs(0.0, 1e-12));
        const Vec3 v(0.3, -0.7, 0.2);
        CHECK_THAT((frame.to_local(frame.to_world(v)) - v).norm(), WithinAbs(0.0, 1e-12));
        CHECK_THAT((frame.to_world(Vec3::UnitZ()) - n).norm(), WithinAbs(0.0, 1e-15));
    }
}
