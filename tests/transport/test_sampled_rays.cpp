// Rays of observers against their densities, and roulette.
#include "optics/transport/backward_trace.h"
#include "tests/support/check_mean.h"
#include "tests/support/chi_square.h"
#include "tests/support/direction_cells.h"
#include "validation/scene_builder.h"

using namespace lucerna;
using namespace lucerna::optics;
using namespace lucerna::test;
using validation::SceneBuilder;

namespace {

/// The rays with which the only observer of a scene begins its paths; nothing stands in their way.
std::vector<Ray> first_rays(SceneBuilder scene, int samples_per_pixel, std::uint32_t phases) {
    // Below all observers, so that neither it nor its light is met.
    scene.object("floor", Rectangle{{-1, -1, -9}, {2, 0, 0}, {0, 2, 0}}, scene.black());
    scene.light("light", PointLight{{0, 0, -8}}, 1.0);
    Settings settings;
    settings.samples_per_pixel = samples_per_pixel;
    const Stage stage(scene.parts);
    const SensorPlanes planes(scene.parts, stage.caster(), 0.1);
    const Collection collection = Collection::of(Method::path, PlantedError::none);
    const ForwardMaps no_maps;
    std::vector<Ray> rays;
    for (std::uint32_t number = 0; number < phases; ++number) {
        Phase phase(stage, settings.seed, number);
        phase.ray_log = &rays;
        const Readings readings(scene.parts, settings);
        PhaseReadings values = readings.new_phase();
        BackwardTally tally;
        const BackwardRays own(scene.parts, readings, settings);
        for (const BinBlock& block : own.blocks()) {
            trace_backward(phase, {collection, collection},
                           readings.observers()[block.observer_bins], own, block, planes, no_maps,
                           values, tally);
        }
    }
    return rays;
}

/// Checks the directions of rays against a density within a cone, and a wrong one.
void check_directions(const std::vector<Ray>& rays, const DirectionCells& cells,
                      const Density& density, const Density& wrong) {
    const int n = static_cast<int>(rays.size());
    auto ray = rays.begin();
    const auto counts =
        cells.counts([&](double, double, double) { return std::optional((ray++)->direction); }, n);
    const auto expected = cells.expected(density, n);
    check_follows(counts, expected);
    check_refutes(counts, expected, cells.expected(wrong, n));
}

}  // namespace

TEST_CASE("Rays of a camera fill its pixels evenly", "[statistical]") {
    constexpr int width = 4, height = 3, parts = 4, samples = 2000;
    const double half_width = std::tan(0.6);
    SceneBuilder scene;
    scene.camera({0, 0, 0}, {0, 5, 0}, {0, 0, 1}, 1.2, width, height);
    const std::vector<Ray> rays = first_rays(scene, samples, 1);
    REQUIRE(rays.size() == width * height * samples);
    std::vector<double> counts(width * height * parts * parts), by_angle = counts;
    for (const Ray& ray : rays) {
        // Pinhole toward +y: right is +x, up is +z, and the image plane is at a distance of 1.
        const double right = ray.direction.x() / ray.direction.y();
        const double up = ray.direction.z() / ray.direction.y();
        const auto cell = [&](double x, double y) {
            const int column = static_cast<int>((x / half_width + 1.0) / 2.0 * width * parts);
            const int row = static_cast<int>((height - y / half_width * width) / 2.0 * parts);
            REQUIRE(column >= 0);
            REQUIRE(column < width * parts);
            REQUIRE(row >= 0);
            REQUIRE(row < height * parts);
            return static_cast<std::size_t>(row * width * parts + column);
        };
        counts[cell(right, up)] += 1.0;
        by_angle[cell(half_width * std::atan(right) / 0.6, up)] += 1.0;
    }
    const std::vector<double> even(counts.size(), samples / static_cast<double>(parts * parts));
    check_follows(counts, even);
    // Twin: pixels of equal angles.
    CHECK(chi_square_deviate(by_angle, even) > chi_square_limit);
}

TEST_CASE("Rays of a luminance meter fill its cone evenly", "[statistical]") {
    const double half_angle_rad = GENERATE(0.01, 0.6);
    SceneBuilder scene;
    scene.meter({0, 0, 0}, {1, 2, 3}, half_angle_rad);
    const DirectionCells cells{Vec3(1, 2, 3).normalized(), half_angle_rad, 6, 8};
    const double height = 2.0 * std::pow(std::sin(0.5 * half_angle_rad), 2);
    check_directions(
        first_rays(scene, 1, 50), cells, [&](const Vec3&) { return 0.5 / pi / height; },
        [&](const Vec3& w) {  // equal steps of the polar angle
            const double sine = cells.axis.cross(w).norm();
            return 0.5 / pi / half_angle_rad / sine;
        });
}

TEST_CASE("Rays of an illuminance point follow the cosine", "[statistical]") {
    SceneBuilder scene;
    const Vec3 normal = Vec3(1, 2, 9).normalized();
    scene.points({{0, 0, 0}}, normal);
    check_directions(
        first_rays(scene, 1, 50), {normal, pi / 2.0, 6, 8},
        [&](const Vec3& w) { return w.dot(normal) / pi; }, [](const Vec3&) { return 0.5 / pi; });
}

TEST_CASE("Roulette keeps the mean of the weight", "[statistical]") {
    // A path whose weight has been multiplied by the factor ends or is scaled up to what it was;
    // without loss it is halved at powers of two from 1024 events on.
    struct Case {
        float factor;
        std::uint32_t events;  ///< without loss, before
        float weight_after;
    };
    const auto [factor, events, weight_after] =
        GENERATE(Case{0.3f, 0, 1.0f}, Case{0.9f, 5000, 1.0f}, Case{1.0f, 10, 1.0f},
                 Case{1.0f, 1023, 2.0f}, Case{1.0f, 1024, 1.0f}, Case{1.5f, 4095, 3.0f});
    CAPTURE(factor, events);
    RandomStream random(4, 0, RandomPurpose::test, 0);
    constexpr int n = 400'000;
    int survivors = 0;
    for (int i = 0; i < n; ++i) {
        Path path{.ray = {Vec3::Zero(), Vec3::UnitZ()},
                  .start = {},
                  .media = {},
                  .weight = Lanes::Constant(factor),
                  .lossless_events = events};
        const Fate fate = roulette(path, factor, random);
        REQUIRE(fate != Fate::trapped);
        if (fate == Fate::ended_by_roulette) continue;
        ++survivors;
        REQUIRE((path.weight - weight_after).abs().maxCoeff() < 1e-6f);
    }
    const double share = survivors / static_cast<double>(n);
    const double mean = share * static_cast<double>(weight_after);
    const double error = std::sqrt(share * (1.0 - share) / n) * static_cast<double>(weight_after);
    check_mean(mean, error, static_cast<double>(factor), {0.025});
    // Twin: survivors that are not scaled up.
    if (share < 1.0) {
        CHECK_FALSE(
            agrees(share * static_cast<double>(factor), error, static_cast<double>(factor)));
    }
}

TEST_CASE("Light that is held for ever is declared trapped, and a black event ends a path",
          "[unit]") {
    RandomStream random(4, 0, RandomPurpose::test, 0);
    Path path{.ray = {Vec3::Zero(), Vec3::UnitZ()},
              .start = {},
              .media = {},
              .weight = Lanes::Ones(),
              .lossless_events = trapped_after_events - 1};
    CHECK(roulette(path, 1.0f, random) == Fate::trapped);
    CHECK(roulette(path, 0.0f, random) == Fate::ended_by_roulette);
    CHECK(roulette(path, std::nanf(""), random) == Fate::ended_by_roulette);
}
