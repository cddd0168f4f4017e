// How many backward rays pixels get, and that their number does not change what they read.
#include <set>

#include "optics/transport/backward_rays.h"
#include "optics/transport/plan.h"
#include "tests/support/cornell_scenes.h"
#include "tests/support/truth_checks.h"

using namespace lucerna;
using namespace lucerna::optics;
using test::SceneBuilder;

namespace {

constexpr int pixels = 32;
constexpr double luminance = 1000.0, radius_m = 0.4;
const Vec3 eye(0.03, -1.0, 0.02);

/// A luminous disk before nothing; its rim crosses pixels.
SceneBuilder disk() {
    SceneBuilder scene;
    scene.area_light(
        scene.object("disk", Disk{Vec3::Zero(), -Vec3::UnitY(), radius_m}, scene.black()),
        luminance);
    scene.camera(eye, {0.03, 0.0, 0.02}, Vec3::UnitZ(), 1.1, pixels, pixels);
    return scene;
}

/// The part of each pixel that the disk covers: the image of a disk across the axis of view is a
/// disk. From points of a grid in the pixel, without rays; wrong by less than 1e-4.
std::vector<double> covered() {
    constexpr int points = 128;
    const double width_m = 2.0 * std::tan(0.55);  // of the image at the disk's distance of 1 m
    std::vector<double> shares;
    for (int row = 0; row < pixels; ++row) {
        for (int column = 0; column < pixels; ++column) {
            int inside = 0;
            for (int k = 0; k < points * points; ++k) {
                const double right = (column + (k % points + 0.5) / points) / pixels - 0.5;
                const double up = 0.5 - (row + (k / points + 0.5) / points) / pixels;
                if (std::hypot(eye.x() + right * width_m, eye.z() + up * width_m) < radius_m) {
                    ++inside;
                }
            }
            shares.push_back(inside / static_cast<double>(points * points));
        }
    }
    return shares;
}

Result run(const SceneBuilder& scene, std::optional<int> samples_per_pixel) {
    Settings settings;
    settings.method = Method::forward;
    settings.threads = 1;
    settings.max_phases = 48;
    settings.samples_per_pixel = samples_per_pixel;
    return simulate(scene.parts, settings);
}

}  // namespace

TEST_CASE("Pixels whose rays differ more get more rays") {
    const SceneBuilder scene = disk();
    const Settings settings;
    const Readings readings(scene.parts, settings);
    BackwardRays rays(scene.parts, readings, settings);
    constexpr std::size_t count = pixels * pixels, special = 5 * pixels + 7, costly = 20 * pixels;
    const std::uint32_t even = rays.of(0, 0).count;
    CHECK(rays.per_phase() == count * even);
    // Standard deviations of 1, and of 10 in one pixel; half of the image costs 16 times as much.
    std::vector<RaySums> sums(count, {.rays = 4, .luminance = 0, .square = 4, .segments = 4});
    sums[special].square = 400;
    for (std::size_t bin = costly; bin < count; ++bin) sums[bin].segments = 64;
    rays.share_out(scene.parts, readings, sums, false, 1);
    CHECK(rays.of(0, special).count > 2 * even);
    CHECK(rays.of(0, special + pixels + 1).count == rays.of(0, special).count);  // its neighbour
    CHECK(rays.of(0, count - 1).count < rays.of(0, 0).count);
    std::set<std::uint32_t> paths;
    double cost = 0.0, even_cost = 0.0;
    for (std::size_t bin = 0; bin < count; ++bin) {
        const BinRays own = rays.of(0, bin);
        CHECK(own.count >= even / 2);
        CHECK(own.per_gather <= own.count);
        for (std::uint32_t i = 0; i < own.count; ++i) paths.insert(own.first_path + i);
        const double of_ray = static_cast<double>(sums[bin].segments / sums[bin].rays);
        cost += own.count * of_ray;
        even_cost += even * of_ray;
    }
    CHECK(paths.size() == rays.per_phase());  // no two rays have the same random numbers
    CHECK(cost <= even_cost);
    std::size_t next = 0;  // blocks hold each bin once, in order
    for (const BinBlock& block : rays.blocks()) {
        CHECK(block.first == next);
        next = block.last;
    }
    CHECK(next == count);
}

TEST_CASE("Rays follow rare bright events also where the pilot met none of them") {
    const SceneBuilder scene = disk();
    const Settings settings;
    const Readings readings(scene.parts, settings);
    constexpr std::size_t count = pixels * pixels, event = 5 * pixels + 7, lonely = 9 * pixels + 10;
    // A single ray a pixel, of deviation 1, and one ray in 81 that met something 100 times as
    // bright.
    const auto rays_of_lonely = [&](float per_pixel) {
        std::vector<RaySums> sums(
            count, {.rays = per_pixel, .luminance = 0, .square = per_pixel, .segments = 4});
        sums[event].square = 1e4f;
        BackwardRays rays(scene.parts, readings, settings);
        rays.share_out(scene.parts, readings, sums, false, 1);
        CHECK(rays.of(0, lonely).count >= rays.of(0, 25 * pixels + 25).count);
        return static_cast<double>(rays.of(0, lonely).count) / rays.of(0, 25 * pixels + 25).count;
    };
    // Its variance, 1e4 in 9 of 81 pixels, is 123 on average, a deviation of 8 for half of it.
    CHECK(rays_of_lonely(1.0f) >= 4.0);
    CHECK(rays_of_lonely(4.0f) == 1.0);
}

TEST_CASE("Kernels are narrowed for a bias beyond the noise of photons, and not by lucky pilots") {
    const SceneBuilder scene = disk();
    const Settings settings;
    const Readings readings(scene.parts, settings);
    constexpr std::size_t count = pixels * pixels;
    // Three pilots that happen to agree on a bias of 1, where photons are as many as make it vary
    // by the variance or more.
    const auto narrowed_at = [&](float variance) {
        const std::vector<RaySums> pilot(
            count,
            {.rays = 1, .segments = 1, .kernel_bias = 1.0f, .kernel_bias_variance = variance});
        BackwardRays rays(scene.parts, readings, settings);
        rays.look_at_kernels(scene.parts, readings, std::vector(3, pilot), 1);
        return rays.of(0, count / 2).kernel_scale < 1.0;
    };
    // The mean product of three has the standard deviation variance / sqrt(3): four of them are 1.
    CHECK(narrowed_at(0.0f));
    CHECK(narrowed_at(0.42f));
    CHECK_FALSE(narrowed_at(0.45f));
}

TEST_CASE("The bias of kernels varies over phases about as photons are counted") {
    constexpr std::uint32_t phases = 16;
    const SceneBuilder scene = test::cornell_diffuse(24);
    Settings settings;
    settings.method = Method::forward;
    const Stage stage(scene.parts);
    const SensorPlanes planes(stage.parts(), stage.caster(), 0.1);
    const Readings readings(scene.parts, settings);
    const TraceContext context{stage, planes, readings, Scheduler::ordered, 1};
    Plan plan = make_plan(context, settings);
    plan.rays = BackwardRays::through_tiles(scene.parts, readings);
    const std::size_t count = readings.bin_count();
    std::vector<double> sums(count), squares(count);
    double counted = 0.0;
    for (std::uint32_t i = 0; i < phases; ++i) {
        const Phase phase(stage, 7, i);
        PhaseTrace trace(context);
        const ForwardMaps maps = forward_maps(phase, context, plan, 0, trace);
        const auto rays = trace_single_rays(phase, context, plan, maps, plan.rays.blocks());
        for (std::size_t bin = 0; bin < count; ++bin) {
            const auto bias = static_cast<double>(rays[bin].kernel_bias);
            sums[bin] += bias;
            squares[bin] += bias * bias;
            counted += static_cast<double>(rays[bin].kernel_bias_variance) / phases;
        }
    }
    double measured = 0.0;
    for (std::size_t bin = 0; bin < count; ++bin) {
        measured += (squares[bin] - sums[bin] * sums[bin] / phases) / (phases - 1.0);
    }
    INFO("sums of variances: " << measured << " measured, " << counted << " from counts");
    REQUIRE(counted > 0.0);
    CHECK(measured > 0.8 * counted);
    CHECK(measured < 2.0 * counted);  // kernels that rims cut have more
}

TEST_CASE("Blocks spread out over an image are all others, and stand in all of its columns") {
    constexpr std::size_t columns = 4, all = 100 * columns, count = 100;
    std::set<std::size_t> blocks, of_columns;
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t block = spread_out(i, count, all);
        CHECK(block / columns == i);
        blocks.insert(block);
        of_columns.insert(block % columns);
    }
    CHECK(blocks.size() == count);
    CHECK(of_columns.size() == columns);
    CHECK(spread_out(6, 7, 7) == 6);
    // As many of each column, within the few that any even sequence is off by.
    for (std::size_t column = 0; column < columns; ++column) {
        const auto in_column = std::count_if(blocks.begin(), blocks.end(),
                                             [&](std::size_t b) { return b % columns == column; });
        CHECK(std::abs(static_cast<double>(in_column) - count / columns) <= 2.0);
    }
}

TEST_CASE("The rim of a lamp: pixels read what it covers of them", "[analytic]") {
    const SceneBuilder scene = disk();
    const std::vector<double> share = covered();
    const Image image = run(scene, std::nullopt).images.front();
    const Image even = run(scene, 8).images.front();
    // Of the pixels on the rim: their sum, and the noise of what their rays happen to hit, which is
    // that beyond the noise of the colours that all pixels of a phase share.
    const double of_colours =
        image.luminance[pixels / 2 * (pixels + 1)].standard_error() / luminance;
    double sum = 0.0, truth = 0.0, noise = 0.0, noise_of_even = 0.0;
    for (std::size_t i = 0; i < share.size(); ++i) {
        if (share[i] == 0.0 || share[i] == 1.0) continue;
        sum += image.luminance[i].value();
        truth += share[i] * luminance;
        const double shared = std::pow(of_colours * share[i] * luminance, 2);
        noise += std::pow(image.luminance[i].standard_error(), 2) - shared;
        noise_of_even += std::pow(even.luminance[i].standard_error(), 2) - shared;
    }
    INFO("variance " << noise << ", with the same rays for all pixels " << noise_of_even);
    CHECK(noise < 0.25 * noise_of_even);
    const double error = std::sqrt(noise) + of_colours * truth;
    test::check_mean(sum, error, truth, {0.02}, 1e-4 * truth);
    CHECK_FALSE(test::agrees(sum, error, 1.02 * truth));
}
