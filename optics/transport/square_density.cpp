#include "optics/transport/square_density.h"

#include <algorithm>

namespace lucerna::optics {

SquareDensity::SquareDensity(std::size_t side, std::span<const double> weights, double share_even)
    : side_(side) {
    double total = 0.0;
    for (const double weight : weights) total += weight;
    const auto cells = static_cast<double>(side * side);
    std::vector<double> of_rows, of_cells;
    for (std::size_t row = 0; row < side; ++row) {
        of_cells.clear();
        double sum = 0.0;
        for (const double weight : weights.subspan(row * side, side)) {
            const double learned = total > 0.0 ? weight / total : 1.0 / cells;
            of_cells.push_back(share_even / cells + (1.0 - share_even) * learned);
            sum += of_cells.back();
        }
        of_rows.push_back(sum);
        columns_.emplace_back(of_cells);
    }
    rows_ = DiscreteDistribution(of_rows);
}

std::size_t SquareDensity::line(std::size_t side, double u) {
    return std::min(static_cast<std::size_t>(u * static_cast<double>(side)), side - 1);
}

double SquareDensity::warp(double& u1, double& u2) const {
    if (even()) return 1.0;
    const auto side = static_cast<double>(side_);
    double rest = 0.0;
    const std::size_t row = rows_.sample(u1, &rest);
    u1 = (static_cast<double>(row) + rest) / side;
    const std::size_t column = columns_[row].sample(u2, &rest);
    u2 = (static_cast<double>(column) + rest) / side;
    return 1.0 / (side * side * rows_.probability(row) * columns_[row].probability(column));
}

double SquareDensity::density(double u1, double u2) const {
    if (even()) return 1.0;
    const auto side = static_cast<double>(side_);
    const std::size_t row = line(side_, u1);
    return side * side * rows_.probability(row) * columns_[row].probability(line(side_, u2));
}

std::vector<double> with_neighbours(std::size_t side, std::span<const double> values) {
    std::vector<double> means;
    means.reserve(values.size());
    for (std::size_t row = 0; row < side; ++row) {
        for (std::size_t column = 0; column < side; ++column) {
            double sum = 0.0;
            double count = 0.0;
            for (std::size_t i = row - std::min<std::size_t>(row, 1);
                 i <= std::min(row + 1, side - 1); ++i) {
                for (std::size_t j = column - std::min<std::size_t>(column, 1);
                     j <= std::min(column + 1, side - 1); ++j) {
                    const double share = (i == row ? 2.0 : 1.0) * (j == column ? 2.0 : 1.0);
                    sum += share * values[i * side + j];
                    count += share;
                }
            }
            means.push_back(sum / count);
        }
    }
    return means;
}

}  // namespace lucerna::optics
