// Rays of sensors that are scattered to where light arrives from: they still stand for all
// directions, and have less noise.
#include "optics/transport/square_density.h"
#include "tests/support/chi_square.h"
#include "tests/support/truth_checks.h"

using namespace lucerna;
using namespace lucerna::optics;
using test::SceneBuilder;

TEST_CASE("Numbers go where their density is", "[statistical]") {
    constexpr std::size_t side = 4;
    std::vector<double> weights(side * side);
    for (std::size_t i = 0; i < weights.size(); ++i) weights[i] = static_cast<double>(i * i);
    const SquareDensity density(side, weights, 0.25);
    constexpr int count = 100000;
    std::vector<double> counts(64), expected(64);
    for (int i = 0; i < count; ++i) {
        RandomStream random(3, 0, RandomPurpose::test, static_cast<std::uint64_t>(i));
        double u1 = random.uniform(), u2 = random.uniform();
        const double factor = density.warp(u1, u2);
        REQUIRE((u1 >= 0.0 && u1 < 1.0 && u2 >= 0.0 && u2 < 1.0));
        CHECK(std::abs(factor * density.density(u1, u2) - 1.0) < 1e-12);
        counts[SquareDensity::cell(8, u1, u2)] += 1.0;
    }
    for (std::size_t i = 0; i < 64; ++i) {
        const double u1 = (static_cast<double>(i / 8) + 0.5) / 8.0;
        const double u2 = (static_cast<double>(i % 8) + 0.5) / 8.0;
        expected[i] = count / 64.0 * density.density(u1, u2);
    }
    CHECK(test::chi_square_deviate(counts, expected) < test::chi_square_limit);
    // The first cell has no weight of its own and a quarter of the even density.
    CHECK(std::abs(density.density(0.1, 0.1) - 0.25) < 1e-12);
    // Twin: rows and columns exchanged.
    for (std::size_t i = 0; i < 64; ++i) {
        const double u1 = (static_cast<double>(i % 8) + 0.5) / 8.0;
        const double u2 = (static_cast<double>(i / 8) + 0.5) / 8.0;
        expected[i] = count / 64.0 * density.density(u1, u2);
    }
    CHECK(test::chi_square_deviate(counts, expected) > test::chi_square_limit);
    // Without anything learned numbers stay as they are.
    double u1 = 0.3, u2 = 0.7;
    CHECK(SquareDensity().warp(u1, u2) == 1.0);
    CHECK((u1 == 0.3 && u2 == 0.7));
}

TEST_CASE("A bright spot of the ceiling lights a floor and what lies on it", "[analytic]") {
    const auto method = GENERATE(Method::combined, Method::path);
    constexpr double rho = 0.8, spot_radius_m = 0.1, height_m = 2.0, flux_lm = 100.0;
    constexpr double paper_rho = 0.5, paper_m = 0.4, aside_m = 0.7;
    SceneBuilder scene;
    scene.object("spot", Disk{{0, 0, height_m}, -Vec3::UnitZ(), spot_radius_m + 1e-3},
                 scene.diffuse(rho));
    scene.object("floor", Rectangle{{-3, -3, 0}, {6, 0, 0}, {0, 6, 0}}, scene.black());
    // What it sends back to the spot and receives again is below 1e-4.
    scene.object(
        "paper",
        Rectangle{{aside_m - paper_m / 2, -paper_m / 2, 1e-4}, {paper_m, 0, 0}, {0, paper_m, 0}},
        scene.diffuse(paper_rho));
    scene.light("beam", BeamLight{Disk{{0, 0, 1}, Vec3::UnitZ(), spot_radius_m}, Vec3::UnitZ()},
                flux_lm);
    const std::vector<Vec3> points{{0, 0, 0}, {1.2, 0.4, 0}};
    scene.points(points, Vec3::UnitZ());
    scene.meter({aside_m + 0.3, 0, 0.4}, {aside_m, 0, 0}, 0.01);
    constexpr std::uint32_t phases = 400;
    const Result result = test::run(scene, method, {phases, 1000});
    INFO("method " << static_cast<int>(method));
    // A disk that is parallel to the point's plane: E = M / 2 (1 - (a^2 + h^2 - r^2) /
    // sqrt((a^2 + h^2 + r^2)^2 - 4 a^2 r^2)); over its centre M r^2 / (h^2 + r^2).
    const auto illuminance = [&](double a, double h) {
        const double exitance = rho * flux_lm / (pi * square(spot_radius_m));
        const double sum = a * a + h * h;
        const double r2 = square(spot_radius_m);
        return 0.5 * exitance * (1.0 - (sum - r2) / std::sqrt(square(sum + r2) - 4.0 * a * a * r2));
    };
    const double on_axis = illuminance(0.0, height_m);
    REQUIRE(std::abs(on_axis - rho * flux_lm / pi / (square(height_m) + square(spot_radius_m))) <
            1e-9 * on_axis);
    const std::vector<double> truths{on_axis, illuminance(points[1].head<2>().norm(), height_m),
                                     paper_rho / pi * illuminance(aside_m, height_m - 1e-4)};
    for (std::size_t i = 0; i < truths.size(); ++i) {
        const Estimate& estimate = result.quantities[i].estimate;
        INFO("reading " << i << ": " << estimate.value() << " +/- " << estimate.standard_error()
                        << ", truth " << truths[i]);
        test::check_mean(estimate.value(), estimate.standard_error(), truths[i],
                         test::truth_detects);
        test::check_refutes(estimate, 1.02 * truths[i]);
        // By the cosine alone a share p = E / M of the 4096 rays of a phase meets the spot, and
        // the relative standard error is 1 / sqrt(n p): 3.9 % on the axis.
        const double p = on_axis / (rho * flux_lm / (pi * square(spot_radius_m)));
        CHECK(estimate.standard_error() < 0.2 / std::sqrt(phases * 4096.0 * p) * truths[i]);
    }
}
