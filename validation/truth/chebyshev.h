// Smooth functions that are costly to evaluate.
#pragma once

#include <cmath>
#include <numbers>
#include <vector>

namespace lucerna::truth {

/// The polynomial through a function at Chebyshev's nodes of the first kind on [a, b]. If the
/// function is analytic there, its error falls by the same factor with each further node.
class Chebyshev {
public:
    template <typename Function>
    Chebyshev(const Function& f, double a, double b, int nodes) {
        for (int i = 0; i < nodes; ++i) {
            const double angle = (i + 0.5) * std::numbers::pi / nodes;
            nodes_.push_back({0.5 * (a + b) + 0.5 * (b - a) * std::cos(angle), 0.0,
                              (i % 2 == 0 ? 1.0 : -1.0) * std::sin(angle)});
            nodes_.back().value = f(nodes_.back().at);
        }
    }

    /// Second barycentric formula (Berrut and Trefethen, SIAM Review 46(3), 2004, 501-517, sections
    /// 4 and 5).
    double operator()(double x) const {
        double above = 0.0, below = 0.0;
        for (const Node& node : nodes_) {
            if (x == node.at) return node.value;
            const double share = node.weight / (x - node.at);
            above += share * node.value;
            below += share;
        }
        return above / below;
    }

private:
    struct Node {
        double at, value, weight;
    };
    std::vector<Node> nodes_;
};

}  // namespace lucerna::truth
