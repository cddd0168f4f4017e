#include "optics/light/goniometer.h"

#include <cmath>

namespace lucerna::optics {
namespace {

constexpr double rad_per_deg = pi / 180.0;

double degrees(double angle_rad) {
    return angle_rad / rad_per_deg;
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

}  // namespace lucerna::optics
