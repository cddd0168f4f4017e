#include "optics/geometry/polygon.h"

#include <cmath>
#include <numeric>

namespace lucerna::optics {

namespace {

/// Normal whose length is twice the area projected along it (Newell's method, Sutherland et al.
/// 1974).
Vec3 twice_area(std::span<const Vec3> corners) {
    Vec3 sum = Vec3::Zero();
    for (std::size_t i = 1; i + 1 < corners.size(); ++i)
        sum += (corners[i] - corners[0]).cross(corners[i + 1] - corners[0]);
    return sum;
}

/// Twice the signed area of a triangle.
double turn(const Vec2& a, const Vec2& b, const Vec2& c) {
    return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

/// True if the corner at `i` sticks out and no other corner lies in the triangle that it spans.
bool is_ear(const std::vector<Vec2>& points, const std::vector<std::uint32_t>& ring,
            std::size_t i) {
    const std::size_t n = ring.size();
    const Vec2& a = points[ring[(i + n - 1) % n]];
    const Vec2& b = points[ring[i]];
    const Vec2& c = points[ring[(i + 1) % n]];
    if (turn(a, b, c) <= 0.0) return false;
    for (std::size_t k = 2; k + 1 < n; ++k) {
        const Vec2& p = points[ring[(i + k) % n]];
        if (p == a || p == c) continue;
        if (turn(a, b, p) >= 0.0 && turn(b, c, p) >= 0.0 && turn(c, a, p) >= 0.0) return false;
    }
    return true;
}

}  // namespace

std::optional<std::vector<std::array<std::uint32_t, 3>>> triangulate_polygon(
    std::span<const Vec3> corners) {
    if (corners.size() < 3) return std::nullopt;
    if (corners.size() == 3) return std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}};
    const Vec3 normal = twice_area(corners);
    if (!(normal.norm() > 0.0)) return std::nullopt;
    const Frame frame(normal.normalized());
    std::vector<Vec2> points;
    points.reserve(corners.size());
    for (const Vec3& corner : corners)
        points.push_back(frame.to_local(corner - corners[0]).head<2>());

    std::vector<std::uint32_t> ring(corners.size());
    std::iota(ring.begin(), ring.end(), 0u);
    std::vector<std::array<std::uint32_t, 3>> triangles;
    triangles.reserve(corners.size() - 2);
    while (ring.size() > 3) {
        const std::size_t n = ring.size();
        std::size_t ear = 0;
        while (ear < n && !is_ear(points, ring, ear)) ++ear;
        if (ear == n) {  // no ear: take off a corner on a straight line, if there is one
            ear = 0;
            while (ear < n && turn(points[ring[(ear + n - 1) % n]], points[ring[ear]],
                                   points[ring[(ear + 1) % n]]) != 0.0)
                ++ear;
            if (ear == n) return std::nullopt;
        }
        triangles.push_back({ring[(ear + n - 1) % n], ring[ear], ring[(ear + 1) % n]});
        ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(ear));
    }
    triangles.push_back({ring[0], ring[1], ring[2]});
    return triangles;
}

}  // namespace lucerna::optics
