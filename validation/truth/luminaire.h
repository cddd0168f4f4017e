// A luminaire with an asymmetric distribution in the C-gamma system, and its intensity.
#pragma once

#include <cmath>
#include <vector>

#include "core/vector.h"
#include "validation/truth/quadrature.h"

namespace lucerna::truth {

/// The grid of the table and its values [cd], [C plane][gamma].
inline const std::vector<double> c_deg{0, 60, 135, 180, 240, 300, 360};
inline const std::vector<double> gamma_deg{0, 20, 45, 70, 90, 120};
inline const std::vector<std::vector<double>> table_cd{
    {300, 420, 250, 90, 30, 0}, {300, 380, 310, 150, 60, 0}, {300, 200, 150, 120, 20, 0},
    {300, 150, 80, 60, 10, 0},  {300, 260, 190, 30, 5, 0},   {300, 510, 440, 210, 90, 0},
    {300, 420, 250, 90, 30, 0}};

inline double between(const std::vector<double>& grid, const std::vector<double>& values,
                      double at) {
    for (std::size_t i = 1; i < grid.size(); ++i) {
        if (at > grid[i]) continue;
        const double t = (at - grid[i - 1]) / (grid[i] - grid[i - 1]);
        return values[i - 1] + t * (values[i] - values[i - 1]);
    }
    return 0.0;
}

/// I(C, gamma) [cd], bilinear in the angles [deg].
inline double intensity_cd(double c, double gamma) {
    std::vector<double> of_planes;
    for (const auto& plane : table_cd) of_planes.push_back(between(gamma_deg, plane, gamma));
    return between(c_deg, of_planes, c);
}

/// Axes of the luminaire in the scene: C = 0, C = 90 and up (against gamma = 0).
struct Axes {
    Vec3 c0, c90, up;
};

/// Turned about the vertical, then its C = 0 side lifted.
inline Axes axes(double turn_deg, double lift_deg) {
    const double turn = turn_deg * rad_per_deg;
    const double lift = lift_deg * rad_per_deg;
    const Vec3 c90(-std::sin(turn), std::cos(turn), 0.0);
    const Vec3 level(std::cos(turn), std::sin(turn), 0.0);
    return {std::cos(lift) * level + std::sin(lift) * Vec3::UnitZ(), c90,
            std::cos(lift) * Vec3::UnitZ() - std::sin(lift) * level};
}

/// Intensity toward a direction that leaves the luminaire [cd].
inline double intensity_toward(const Axes& a, const Vec3& direction) {
    const double gamma = std::acos(-direction.dot(a.up)) / rad_per_deg;
    double c = std::atan2(direction.dot(a.c90), direction.dot(a.c0)) / rad_per_deg;
    if (c < 0.0) c += 360.0;
    return intensity_cd(c, gamma);
}

/// Integral of I over all directions; exact but for rounding, cell by cell of the table.
inline double total_flux_lm() {
    double flux = 0.0;
    for (std::size_t i = 1; i < c_deg.size(); ++i) {
        flux += integral(
            [&](double c) {
                double of_plane = 0.0;
                for (std::size_t g = 1; g < gamma_deg.size(); ++g) {
                    of_plane += integral(
                        [&](double gamma) {
                            return intensity_cd(c, gamma) * std::sin(gamma * rad_per_deg) *
                                   rad_per_deg;
                        },
                        gamma_deg[g - 1], gamma_deg[g], 1);
                }
                return of_plane * rad_per_deg;
            },
            c_deg[i - 1], c_deg[i], 1);
    }
    return flux;
}

}  // namespace lucerna::truth
