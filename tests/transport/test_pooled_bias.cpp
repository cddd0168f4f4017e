// The bias of cut kernels, told by all that are cut alike around them.
#include "optics/transport/pooled_bias.h"

#include <catch2/catch.hpp>

#include "core/random.h"

using namespace lucerna;
using namespace lucerna::optics;

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
