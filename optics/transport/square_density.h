// A density over pairs of uniform numbers, learned from pairs that mattered.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/sampling.h"

namespace lucerna::optics {

/// A density over the unit square, constant in the cells of a square grid.
class SquareDensity {
public:
    SquareDensity() = default;  ///< even
    /// @param weights     of the cells, row by row; the row is that of the first number.
    /// @param share_even  of the probability, above 0, spread evenly: no cell is left out.
    SquareDensity(std::size_t side, std::span<const double> weights, double share_even);

    bool even() const { return side_ == 1; }

    /// Moves a pair of uniform numbers to where the density is; returns 1 over the density there.
    double warp(double& u1, double& u2) const;
    double density(double u1, double u2) const;

    /// Index of the cell of a pair.
    static std::size_t cell(std::size_t side, double u1, double u2) {
        return line(side, u1) * side + line(side, u2);
    }

private:
    static std::size_t line(std::size_t side, double u);

    std::size_t side_ = 1;
    DiscreteDistribution rows_;
    std::vector<DiscreteDistribution> columns_;  // of each row
};

/// Each cell's value averaged with those of its neighbours: what matters does not end where the few
/// pairs that it was learned from do.
std::vector<double> with_neighbours(std::size_t side, std::span<const double> values);

}  // namespace lucerna::optics
