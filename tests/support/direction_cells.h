// Cells of direction: integrals of a density over them by quadrature, and counts of samples.
#pragma once

#include <cmath>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "core/random.h"
#include "core/vector.h"

namespace lucerna::test {

/// Composite Gauss rule with three points: nodes and weights on [0, 1], divided into equal parts.
inline std::vector<std::pair<double, double>> gauss_rule(int parts) {
    std::vector<std::pair<double, double>> rule;
    for (int i = 0; i < parts; ++i) {
        for (const auto& [x, w] :
             {std::pair(0.5 - std::sqrt(0.15), 5.0 / 18.0), std::pair(0.5, 8.0 / 18.0),
              std::pair(0.5 + std::sqrt(0.15), 5.0 / 18.0)}) {
            rule.emplace_back((i + x) / parts, w / parts);
        }
    }
    return rule;
}

/// Calls add(direction, solid angle, theta node, phi node) for a quadrature of the cone around +z
/// of the given half angle.
template <typename Add>
void over_cone(double half_angle_rad, int theta_parts, int phi_parts, Add add) {
    const auto thetas = gauss_rule(theta_parts), phis = gauss_rule(phi_parts);
    for (std::size_t t = 0; t < thetas.size(); ++t) {
        const double theta = half_angle_rad * thetas[t].first;
        for (std::size_t p = 0; p < phis.size(); ++p) {
            const double phi = 2.0 * pi * phis[p].first;
            add(Vec3(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                     std::cos(theta)),
                std::sin(theta) * half_angle_rad * 2.0 * pi * thetas[t].second * phis[p].second, t,
                p);
        }
    }
}

using Density = std::function<double(const Vec3&)>;  ///< [1/sr]
/// A direction, or nothing where the sampler gives none.
using DirectionSampler = std::function<std::optional<Vec3>(double u1, double u2, double u3)>;

/// Equal steps of polar angle and of azimuth around an axis, and one cell for all else: directions
/// outside the cone, and samples without a direction.
struct DirectionCells {
    Vec3 axis = Vec3::UnitZ();
    double half_angle_rad = pi;
    int theta_cells = 20, phi_cells = 20;

    /// Expected counts of `sample_count` samples by a quadrature with 3 `parts` nodes per cell and
    /// angle; what the density leaves to 1 is expected in the cell for all else.
    std::vector<double> expected(const Density& density, int sample_count, int parts = 4) const {
        std::vector<double> cells(static_cast<std::size_t>(theta_cells * phi_cells) + 1);
        const Frame frame(axis);
        const auto per_cell = static_cast<std::size_t>(3 * parts);
        double total = 0.0;
        over_cone(half_angle_rad, theta_cells * parts, phi_cells * parts,
                  [&](const Vec3& w, double solid_angle, std::size_t t, std::size_t p) {
                      const double share = density(frame.to_world(w)) * solid_angle * sample_count;
                      cells[t / per_cell * static_cast<std::size_t>(phi_cells) + p / per_cell] +=
                          share;
                      total += share;
                  });
        cells.back() = std::max(0.0, sample_count - total);
        return cells;
    }

    std::vector<double> counts(const DirectionSampler& sample, int sample_count) const {
        std::vector<double> cells(static_cast<std::size_t>(theta_cells * phi_cells) + 1);
        const Frame frame(axis);
        RandomStream random(7, 0, RandomPurpose::test, 1);
        for (int i = 0; i < sample_count; ++i) {
            const double u1 = random.uniform(), u2 = random.uniform(), u3 = random.uniform();
            const std::optional<Vec3> w = sample(u1, u2, u3);
            const Vec3 local = w ? frame.to_local(*w) : Vec3::Zero();
            const double theta = std::atan2(std::hypot(local.x(), local.y()), local.z());
            if (!w || theta > half_angle_rad) {
                cells.back() += 1.0;
                continue;
            }
            const double turns = std::atan2(local.y(), local.x()) / (2.0 * pi);
            const int t =
                std::min(theta_cells - 1, static_cast<int>(theta / half_angle_rad * theta_cells));
            const int p = std::min(
                phi_cells - 1, static_cast<int>((turns < 0.0 ? turns + 1.0 : turns) * phi_cells));
            cells[static_cast<std::size_t>(t * phi_cells + p)] += 1.0;
        }
        return cells;
    }
};

}  // namespace lucerna::test
