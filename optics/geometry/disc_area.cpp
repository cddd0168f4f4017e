#include "optics/geometry/disc_area.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lucerna::optics {

namespace {

double cross(const Vec2& a, const Vec2& b) {
    return a.x() * b.y() - a.y() * b.x();
}

double signed_angle(const Vec2& a, const Vec2& b) {
    return std::atan2(cross(a, b), a.dot(b));
}

}  // namespace

// Triangles where the edge runs inside the disc, circular sectors where it runs outside.
double disc_edge_area(const Vec2& a, const Vec2& b, double radius) {
    const double radius_squared = radius * radius;
    const bool a_inside = a.squaredNorm() <= radius_squared;
    const bool b_inside = b.squaredNorm() <= radius_squared;
    if (a_inside && b_inside) return 0.5 * cross(a, b);

    // a + s (b - a) is on the circle: alpha s^2 + 2 beta s + gamma = 0
    const Vec2 edge = b - a;
    const double alpha = edge.squaredNorm();
    const double area_twice = cross(a, b);
    const double discriminant = radius_squared * alpha - area_twice * area_twice;
    const auto sector = [&](const Vec2& from, const Vec2& to) {
        return 0.5 * radius_squared * signed_angle(from, to);
    };
    if (discriminant <= 0.0) return sector(a, b);
    const double root = std::sqrt(discriminant);
    const double beta = a.dot(edge);
    const double enter = (-beta - root) / alpha;
    const double leave = (-beta + root) / alpha;
    if (leave <= 0.0 || enter >= 1.0) return sector(a, b);
    const Vec2 p = a_inside ? a : Vec2(a + enter * edge);
    const Vec2 q = b_inside ? b : Vec2(a + leave * edge);
    double area = 0.5 * cross(p, q);
    if (!a_inside) area += sector(a, p);
    if (!b_inside) area += sector(q, b);
    return area;
}

double disc_polygon_area(std::span<const Vec2> polygon, double radius) {
    double area = 0.0;
    for (std::size_t i = 0; i < polygon.size(); ++i)
        area += disc_edge_area(polygon[i], polygon[(i + 1) % polygon.size()], radius);
    return area;
}

double disc_rectangle_area(double x, double y, double width, double height, double radius) {
    if (x >= radius && y >= radius && width - x >= radius && height - y >= radius)
        return pi * radius * radius;
    const std::array corners{Vec2(-x, -y), Vec2(width - x, -y), Vec2(width - x, height - y),
                             Vec2(-x, height - y)};
    return std::max(disc_polygon_area(corners, radius), 0.0);
}

double disc_disc_area(double distance, double radius_1, double radius_2) {
    if (distance >= radius_1 + radius_2) return 0.0;
    const double smaller = std::min(radius_1, radius_2);
    if (distance <= std::abs(radius_1 - radius_2)) return pi * smaller * smaller;
    // Two circular segments on the common chord, at signed distance x from the first centre.
    const double x = 0.5 * (distance + (radius_1 - radius_2) * (radius_1 + radius_2) / distance);
    const auto segment = [](double radius, double chord_distance) {
        const double half_chord =
            std::sqrt(std::max((radius - chord_distance) * (radius + chord_distance), 0.0));
        return radius * radius * std::atan2(half_chord, chord_distance) -
               chord_distance * half_chord;
    };
    return segment(radius_1, x) + segment(radius_2, distance - x);
}

}  // namespace lucerna::optics
