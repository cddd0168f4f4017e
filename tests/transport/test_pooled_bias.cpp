// The bias of cut kernels, told by all that are cut alike around them.
#include "optics/transport/pooled_bias.h"

#include "core/random.h"
#include "optics/transport/bin_gathers.h"
#include "tests/support/traced_scene.h"
#include "tests/support/truth_checks.h"

using namespace lucerna;
using namespace lucerna::optics;
using test::TracedScene;

namespace {

constexpr float whole_m = 0.01f;

// On a plane that no axis lies in.
CutKernel kernel(double x_m, double y_m, double left, double bias, double weight = 1.0,
                 std::uint32_t side = 3) {
    const Frame plane(Vec3(1.0, 2.0, 3.0).normalized());
    const Vec3 position = Vec3(5.0, 6.0, 7.0) + x_m * plane.tangent + y_m * plane.bitangent;
    return {.bin = 0,
            .side = side,
            .position = position.cast<float>(),
            .normal = plane.normal.cast<float>(),
            .whole_m = whole_m,
            .left = static_cast<float>(left),
            .weight = static_cast<float>(weight),
            .bias = static_cast<float>(bias)};
}

std::vector<double> pooled(const std::vector<CutKernel>& kernels) {
    return pooled_bias({&kernels, 1}, 1);
}

}  // namespace

TEST_CASE("Cut kernels tell together as much bias as each by itself", "[analytic]") {
    RandomStream random(1, 0, RandomPurpose::test, 0);
    std::vector<CutKernel> kernels;
    double alone = 0.0, size = 0.0;
    for (int i = 0; i < 3000; ++i) {
        const double x = random.uniform(), y = random.uniform(), left = random.uniform();
        const double bias = random.uniform() - 0.3, weight = random.uniform();
        kernels.push_back(kernel(x, y, left, bias, weight, random.uniform() < 0.5 ? 3 : 8));
        alone += weight * bias;
        size += weight * std::abs(bias);
    }
    const std::vector<double> bias = pooled(kernels);
    double together = 0.0;
    for (std::size_t i = 0; i < kernels.size(); ++i) {
        together += static_cast<double>(kernels[i].weight) * bias[i];
    }
    CHECK(std::abs(together - alone) < 1e-6 * size);

    // The same bits for any number of threads, however the kernels come.
    std::vector<std::vector<CutKernel>> lists(7);
    for (std::size_t i = 0; i < kernels.size(); ++i)
        lists[i * 7 / kernels.size()].push_back(kernels[i]);
    CHECK(pooled_bias(lists, 3) == bias);
    CHECK(pooled_bias({}, 1).empty());
}

TEST_CASE("Kernels that are cut otherwise tell nothing of each other's bias", "[analytic]") {
    // Along an edge; further from it; on the other side of the patch; on another patch; and along
    // another edge, more than two nodes away.
    std::vector<CutKernel> kernels;
    std::vector<double> alone;
    const auto add = [&](double bias, double x_m, double left, std::uint32_t side) {
        for (int i = 0; i < 50; ++i) {
            kernels.push_back(kernel(x_m, 0.004 * i, left, bias, 1.0, side));
            alone.push_back(bias);
        }
    };
    add(2.0, 0.0, 0.5, 3);
    add(-1.0, 0.008, 0.9, 3);
    add(7.0, 0.0, 0.5, 2);
    add(11.0, 0.0, 0.5, 5);
    add(4.0, 0.1, 0.5, 3);
    const std::vector<double> bias = pooled(kernels);
    double worst = 0.0;
    for (std::size_t i = 0; i < bias.size(); ++i) {
        worst = std::max(worst, std::abs(bias[i] - alone[i]));
    }
    CHECK(worst < 1e-6);
}

TEST_CASE("The pooled bias has the noise of a mean along the edge", "[analytic]") {
    // Independent noise of variance 1. Of m kernels between two nodes, node means have the variance
    // 2/3 / m and neighbours the covariance 1/6 / m: integrals of (1 - |t|)^2 and of t (1 - t).
    // Between nodes, in the mean over all places, that makes 2/3 * 2/3 / m + 1/3 * 1/6 / m
    // = 1 / (2 m).
    constexpr int per_node = 40, count = 12 * per_node, trials = 1000;
    constexpr double node_m = 4.0 * static_cast<double>(whole_m);
    RandomStream random(2, 0, RandomPurpose::test, 0);
    double sum = 0.0;
    std::size_t read = 0;
    for (int trial = 0; trial < trials; ++trial) {
        std::vector<CutKernel> kernels;
        const double start = random.uniform();
        for (int i = 0; i < count; ++i) {
            const double noise = std::sqrt(12.0) * (random.uniform() - 0.5);
            kernels.push_back(kernel(start, start + i * node_m / per_node, 0.6, noise));
        }
        const std::vector<double> bias = pooled(kernels);
        for (int i = 3 * per_node; i < count - 3 * per_node; ++i) {
            sum += square(bias[static_cast<std::size_t>(i)]);
            ++read;
        }
    }
    const double variance = sum / static_cast<double>(read), expected = 1.0 / (2.0 * per_node);
    // Some 7 nodes of each trial know nothing of each other: 7000 squares of standard deviation
    // sqrt 2, of which 4 are allowed.
    const double tolerance = 4.0 * std::sqrt(2.0 / 7000.0);
    INFO("variance " << variance << ", expected " << expected);
    CHECK(std::abs(variance / expected - 1.0) < tolerance);
    // Were only the nearest node read:
    CHECK_FALSE(std::abs(variance / (2.0 / 3.0 / per_node) - 1.0) < tolerance);
}

TEST_CASE("Rays for which one kernel stands have its bias once", "[analytic]") {
    // E = 1 + x / r on a white plate that ends at x = 0. Half of a disc around a point of the rim
    // has its middle at 4 r / 3 pi, which is the bias of E, and which both of its kernels tell.
    constexpr double radius_m = 0.05, step_m = radius_m / 80.0, rays = 7.0;
    test::SceneBuilder scene;
    const BsdfId paint = scene.diffuse(1.0);
    const ObjectId plate = scene.object("plate", Rectangle{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, paint);
    scene.light("lamp", PointLight{{0, 0, 1}}, 1.0);
    scene.camera({0, 0.5, 1}, {0, 0.5, 0}, Vec3::UnitY(), 0.01, 1, 1);
    TracedScene traced(scene);
    std::vector<Photon> photons;
    for (int i = 0; i < 100; ++i) {
        for (int j = -100; j < 100; ++j) {
            const double x = (i + 0.5) * step_m, y = 0.5 + (j + 0.5) * step_m;
            const double flux = (1.0 + x / radius_m) * step_m * step_m * rays;
            photons.push_back({{{x, y, 0}, Vec3::UnitZ(), plate},
                               -Vec3::UnitZ(),
                               Lanes::Constant(static_cast<float>(flux)),
                               History::indirect});
        }
    }
    ForwardMaps maps;
    maps.indirect_radii = Radii(std::vector<double>(traced.stage.patch_count(), radius_m));
    maps.indirect_radii.tell_cut_kernels_apart();
    maps.indirect = ForwardMap(traced.stage, maps.indirect_radii, {&photons, 1},
                               static_cast<std::uint64_t>(rays), 1);

    const Phase phase(traced.stage, 1, 0);
    constexpr std::uint32_t count = 8;
    PhaseReadings readings = traced.readings.new_phase();
    BinGathers gathers(phase, traced.readings.observers().front(), maps, readings);
    gathers.start(0, {count, count, 0, 1.0, false, 1.0, nullptr, nullptr});
    const SurfacePoint point{{1e-9, 0.5, 0}, Vec3::UnitZ(), plate};
    const Frame frame(point.normal);
    const Vec3 wo = Vec3::UnitZ();
    const SurfaceOptics optics = optics_at(phase, no_object, no_object, false, 0);
    Path path;
    path.weight = Lanes::Constant(1.0f / count);
    for (std::uint32_t ray = 0; ray < count; ++ray) {
        gathers.next_ray(ray);
        gathers.where_seen({point, frame, wo, traced.stage.parts().bsdfs[paint], optics},
                           mask(History::indirect), path, true);
    }
    std::vector<CutKernel> kernels = gathers.take_cut_kernels();
    REQUIRE(kernels.size() == 1);
    CHECK(std::abs(kernels.front().left - 0.5f) < 1e-6f);
    add_pooled_bias({&kernels, 1}, 1, readings);
    traced.readings.fold(phase, readings, 1);
    const Estimate pixel =
        traced.readings.images(traced.stage.parts(), 1).front().luminance.front();
    const double of_white = phase.luminous(Lanes::Constant(static_cast<float>(1.0 / pi)));
    const double bias = 4.0 / (3.0 * pi);
    CHECK(std::abs(pixel.mean() / of_white - (1.0 + bias)) < 0.01);
    CHECK(std::abs(pixel.bias() / of_white - bias) < 0.02);  // photons stand 1/80 r apart
}

TEST_CASE("Images count the bias of cut kernels with every scheduler", "[unit]") {
    // All kernels that are seen are cut by the rim, and there are no caustics.
    test::SceneBuilder scene;
    scene.object("floor", Rectangle{{0, 0, 0}, {0.02, 0, 0}, {0, 1, 0}}, scene.diffuse(0.5));
    scene.object("wall", Rectangle{{-1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, scene.diffuse(0.5));
    scene.light("lamp", PointLight{{0, 0.5, 0.5}}, 100.0);
    scene.camera({0.01, 0.5, 1}, {0.01, 0.5, 0}, Vec3::UnitY(), 0.01, 4, 4);
    scene.points({{0.5, 0.5, 0.1}}, Vec3::UnitZ());  // has deposits, and so a map of groups
    for (const Scheduler scheduler : {Scheduler::ordered, Scheduler::asynchronous,
                                      Scheduler::synchronous, Scheduler::two_level}) {
        Settings settings = test::settings_of(Method::automatic, {2, 200000});
        settings.scheduler = scheduler;
        settings.threads = 2;
        const Estimate mean = simulate(scene.parts, settings).images.front().mean;
        INFO("scheduler " << static_cast<int>(scheduler) << ": mean " << mean.mean() << ", bias "
                          << mean.bias());
        CHECK(mean.bias() != 0.0);
    }
}
