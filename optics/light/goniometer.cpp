#include "optics/light/goniometer.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace lucerna::optics {
namespace {

double degrees(double angle_rad) {
    return angle_rad / rad_per_deg;
}

// The rounding of the angles must not lose the edge of a table.
bool within(double angle_deg, const std::vector<double>& grid) {
    constexpr double rounding_deg = 1e-9;
    return angle_deg >= grid.front() - rounding_deg && angle_deg <= grid.back() + rounding_deg;
}

// Lower node of the interval that holds the value, and the share of the upper one.
std::pair<std::size_t, double> bracket(const std::vector<double>& grid, double value) {
    const auto above = std::upper_bound(grid.begin() + 1, grid.end() - 1, value);
    const auto i = static_cast<std::size_t>(above - grid.begin()) - 1;
    return {i, std::clamp((value - grid[i]) / (grid[i + 1] - grid[i]), 0.0, 1.0)};
}

}  // namespace

GoniometerAngles type_a_angles(const Vec3& d) {
    return {degrees(std::atan2(-d.y(), d.x())),
            degrees(std::atan2(d.z(), std::hypot(d.x(), d.y())))};
}

Vec3 type_a_direction(const GoniometerAngles& angles) {
    const double h = angles.horizontal_deg * rad_per_deg;
    const double v = angles.vertical_deg * rad_per_deg;
    return {std::cos(v) * std::cos(h), -std::cos(v) * std::sin(h), std::sin(v)};
}

GoniometerAngles type_b_angles(const Vec3& d) {
    return {degrees(std::atan2(-d.y(), std::hypot(d.x(), d.z()))),
            degrees(std::atan2(d.x(), -d.z()))};
}

Vec3 type_b_direction(const GoniometerAngles& angles) {
    const double h = angles.horizontal_deg * rad_per_deg;
    const double v = angles.vertical_deg * rad_per_deg;
    return {std::cos(h) * std::sin(v), -std::sin(h), -std::cos(h) * std::cos(v)};
}

GoniometerTable::GoniometerTable(GoniometerType type, bool mirrored,
                                 std::vector<double> horizontal_deg,
                                 std::vector<double> vertical_deg,
                                 std::vector<std::vector<double>> values)
    : type_(type),
      mirrored_(mirrored),
      horizontal_deg_(std::move(horizontal_deg)),
      vertical_deg_(std::move(vertical_deg)),
      values_(std::move(values)) {}

double GoniometerTable::at(const Vec3& direction) const {
    auto [h, v] = type_ == GoniometerType::a ? type_a_angles(direction) : type_b_angles(direction);
    if (mirrored_) h = std::abs(h);
    if (!within(h, horizontal_deg_) || !within(v, vertical_deg_)) return 0.0;
    const auto [i, s] = bracket(horizontal_deg_, h);
    const auto [j, t] = bracket(vertical_deg_, v);
    return (1.0 - s) * ((1.0 - t) * values_[i][j] + t * values_[i][j + 1]) +
           s * ((1.0 - t) * values_[i + 1][j] + t * values_[i + 1][j + 1]);
}

double GoniometerTable::finest_spacing_deg() const {
    double spacing_deg = 360.0;
    for (const auto* angles : {&horizontal_deg_, &vertical_deg_}) {
        for (std::size_t i = 1; i < angles->size(); ++i) {
            spacing_deg = std::min(spacing_deg, (*angles)[i] - (*angles)[i - 1]);
        }
    }
    return spacing_deg;
}

}  // namespace lucerna::optics
