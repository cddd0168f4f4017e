#include "optics/transport/pooled_bias.h"

#include <array>
#include <cmath>
#include <map>
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
        const auto [nodes, shares] = around(kernel);
        for (unsigned corner = 0; corner < corners; ++corner) {
            const double weight = shares[corner] * static_cast<double>(kernel.weight);
            nodes[corner]->weight += weight;
            nodes[corner]->bias += weight * static_cast<double>(kernel.bias);
        }
    }

    /// @param kernel  one of those that were added.
    double at(const CutKernel& kernel) {
        double bias = 0.0;
        const auto [nodes, shares] = around(kernel);
        for (unsigned corner = 0; corner < corners; ++corner) {
            const Node& node = *nodes[corner];
            if (shares[corner] > 0.0) bias += shares[corner] * node.bias / node.weight;
        }
        return bias;
    }

private:
    struct Node {
        double weight = 0.0, bias = 0.0;
    };
    static constexpr unsigned corners = 8;  // of a cell
    using Cell = std::array<Node*, corners>;
    struct Around {
        const Cell& nodes;
        std::array<double, corners> shares;
    };

    Around around(const CutKernel& kernel) {
        const Vec3 way = kernel.position.cast<double>() - origin_;
        const std::array<double, 3> place{way.dot(frame_.tangent) / spacing_m_ + shift_.x(),
                                          way.dot(frame_.bitangent) / spacing_m_ + shift_.y(),
                                          static_cast<double>(kernel.left) / left_per_node};
        std::array<std::int64_t, 3> below;
        std::array<double, corners> shares;
        shares.fill(1.0);
        for (unsigned axis = 0; axis < 3; ++axis) {
            const double floor = std::floor(place[axis]), rest = place[axis] - floor;
            below[axis] = static_cast<std::int64_t>(floor);
            for (unsigned corner = 0; corner < corners; ++corner) {
                shares[corner] *= corner >> axis & 1u ? rest : 1.0 - rest;
            }
        }
        return {cell(below), shares};
    }

    const Cell& cell(const std::array<std::int64_t, 3>& below) {
        const auto key_of = [&](unsigned corner) {
            constexpr unsigned bits = 64 / 3;
            std::uint64_t key = 0;
            for (unsigned axis = 0; axis < 3; ++axis) {
                const auto index = static_cast<std::uint64_t>(below[axis]) + (corner >> axis & 1u);
                key |= (index & ((std::uint64_t{1} << bits) - 1)) << (axis * bits);
            }
            return key;
        };
        const auto [entry, is_new] = cells_.try_emplace(key_of(0));
        Cell& nodes = entry->second;
        if (is_new) {
            for (unsigned corner = 0; corner < corners; ++corner) {
                nodes[corner] = &nodes_[key_of(corner)];
            }
        }
        return nodes;
    }

    Frame frame_;
    Vec3 origin_;
    double spacing_m_;
    Vec2 shift_;  // the nodes lie elsewhere in each phase
    std::unordered_map<std::uint64_t, Node> nodes_;
    std::unordered_map<std::uint64_t, Cell> cells_;  // one look-up for each kernel, not eight
};

}  // namespace

std::vector<double> pooled_bias(std::span<const std::vector<CutKernel>> lists, int threads) {
    struct Numbered {
        const CutKernel* kernel;
        std::size_t number;
    };
    std::map<std::uint32_t, std::vector<Numbered>> sides;
    std::size_t count = 0;
    for (const auto& list : lists) {
        for (const CutKernel& kernel : list) sides[kernel.side].push_back({&kernel, count++});
    }
    std::vector<const std::vector<Numbered>*> tasks;
    for (const auto& [side, kernels] : sides) tasks.push_back(&kernels);
    std::vector<double> bias(count);
    for_each_block(tasks.size(), threads, [&](std::size_t i) {
        const std::vector<Numbered>& kernels = *tasks[i];
        TableOfBias table(*kernels.front().kernel);
        for (const Numbered& k : kernels) table.add(*k.kernel);
        for (const Numbered& k : kernels) bias[k.number] = table.at(*k.kernel);
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
