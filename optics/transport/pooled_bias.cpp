#include "optics/transport/pooled_bias.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>

#include "core/parallel.h"
#include "optics/transport/cell_grid.h"

namespace lucerna::optics {
namespace {

// Distance of the nodes of a table along the surface, in radii of whole kernels: about as wide is
// the mean.
constexpr double radii_per_node = 4.0;
// Distance of its nodes in what is left of the disc: a fifth of a radius further from the edge.
constexpr double left_per_node = 0.125;

// Of one side of a patch. A kernel shares itself out to the nodes around it, and reads from them,
// with the same shares (the bilateral grid of Chen, Paris and Durand, TOG 26(3), 2007, 103).
class TableOfBias {
public:
    explicit TableOfBias(const CutKernel& first)
        : frame_(first.normal.cast<double>()),
          origin_(first.position.cast<double>()),
          spacing_m_(radii_per_node * static_cast<double>(first.whole_m)),
          shift_(scrambled(origin_), scrambled(-origin_)) {}

    void add(const CutKernel& kernel) {
        for (const auto& [key, share] : nodes_around(kernel)) {
            const double weight = share * static_cast<double>(kernel.weight);
            Node& node = nodes_[key];
            node.weight += weight;
            node.bias += weight * static_cast<double>(kernel.bias);
        }
    }

    double at(const CutKernel& kernel) const {
        double bias = 0.0;
        for (const auto& [key, share] : nodes_around(kernel)) {
            if (share > 0.0) bias += share * nodes_.at(key).bias / nodes_.at(key).weight;
        }
        return bias;
    }

private:
    struct Node {
        double weight = 0.0, bias = 0.0;
    };
    struct Share {
        std::uint64_t key;
        double share;
    };

    std::array<Share, 8> nodes_around(const CutKernel& kernel) const {
        const Vec3 way = kernel.position.cast<double>() - origin_;
        const std::array<double, 3> place{way.dot(frame_.tangent) / spacing_m_ + shift_.x(),
                                          way.dot(frame_.bitangent) / spacing_m_ + shift_.y(),
                                          static_cast<double>(kernel.left) / left_per_node};
        constexpr unsigned bits = 64 / 3;
        std::array<Share, 8> nodes;
        for (unsigned corner = 0; corner < nodes.size(); ++corner) {
            nodes[corner] = {0, 1.0};
            for (unsigned axis = 0; axis < 3; ++axis) {
                const unsigned upper = corner >> axis & 1u;
                const double below = std::floor(place[axis]), rest = place[axis] - below;
                const auto index =
                    static_cast<std::uint64_t>(static_cast<std::int64_t>(below)) + upper;
                nodes[corner].key |= (index & ((std::uint64_t{1} << bits) - 1)) << (axis * bits);
                nodes[corner].share *= upper ? rest : 1.0 - rest;
            }
        }
        return nodes;
    }

    Frame frame_;
    Vec3 origin_;
    double spacing_m_;
    Vec2 shift_;  // the nodes lie elsewhere in each phase
    std::unordered_map<std::uint64_t, Node> nodes_;
};

}  // namespace

std::vector<double> pooled_bias(std::span<const std::vector<CutKernel>> lists, int threads) {
    std::vector<const CutKernel*> kernels;
    for (const auto& list : lists) {
        for (const CutKernel& kernel : list) kernels.push_back(&kernel);
    }
    // Side by side, those of each in the order of the lists.
    std::vector<std::size_t> order(kernels.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    const auto side = [&](std::size_t i) { return kernels[i]->side; };
    std::ranges::stable_sort(order, {}, side);
    std::vector<std::size_t> starts;
    for (std::size_t i = 0; i < order.size(); ++i) {
        if (i == 0 || side(order[i]) != side(order[i - 1])) starts.push_back(i);
    }
    starts.push_back(order.size());
    std::vector<double> bias(kernels.size());
    for_each_block(starts.size() - 1, threads, [&](std::size_t i) {
        const auto of_side = std::span(order).subspan(starts[i], starts[i + 1] - starts[i]);
        TableOfBias table(*kernels[of_side.front()]);
        for (const std::size_t k : of_side) table.add(*kernels[k]);
        for (const std::size_t k : of_side) bias[k] = table.at(*kernels[k]);
    });
    return bias;
}

void add_pooled_bias(std::span<const std::vector<CutKernel>> lists, int threads,
                     PhaseReadings& readings) {
    const std::vector<double> bias = pooled_bias(lists, threads);
    std::size_t i = 0;
    for (const auto& list : lists) {
        for (const CutKernel& kernel : list) {
            readings.add_bias(kernel.bin, static_cast<double>(kernel.weight) * bias[i++]);
        }
    }
}

}  // namespace lucerna::optics
