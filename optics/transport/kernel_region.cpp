#include "optics/transport/kernel_region.h"

#include <algorithm>
#include <numbers>
#include <vector>

#include "optics/geometry/disc_area.h"
#include "optics/transport/cell_grid.h"

namespace lucerna::optics {
namespace {

// Above the plane, in radii: what rises higher is a barrier.
constexpr double height = 0.05;
// A barrier that leans more than this has no line of its own: it is taken to stand across the ray.
constexpr double least_steepness = 0.2;
// Stands for infinity, in radii.
constexpr double far = 1e4;

// The part of a polygon on the side of the line through a and b on which the origin lies.
void clip(std::vector<Vec2>& polygon, const Vec2& a, const Vec2& b) {
    const Vec2 along = b - a;
    const auto cross = [&](const Vec2& p) {
        return along.x() * (p.y() - a.y()) - along.y() * (p.x() - a.x());
    };
    const double inside = cross(Vec2::Zero()) < 0.0 ? -1.0 : 1.0;
    std::vector<Vec2> kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Vec2& p = polygon[i];
        const Vec2& q = polygon[(i + 1) % polygon.size()];
        const double of_p = inside * cross(p), of_q = inside * cross(q);
        if (of_p >= 0.0) kept.push_back(p);
        if ((of_p > 0.0 && of_q < 0.0) || (of_p < 0.0 && of_q > 0.0)) {
            kept.push_back(p + of_p / (of_p - of_q) * (q - p));
        }
    }
    polygon = std::move(kept);
}

}  // namespace

KernelRegion::KernelRegion(const Vec3& centre, const Vec3& side, double radius_m)
    : centre_(centre), radius_m_(radius_m) {
    const Frame frame(side);
    // Directions must not be the same everywhere.
    const double angle = 2.0 * pi / sectors * scrambled(centre);
    x_axis_ = std::cos(angle) * frame.tangent + std::sin(angle) * frame.bitangent;
    y_axis_ = side.cross(x_axis_);
}

Vec2 KernelRegion::local(const Vec3& position) const {
    const Vec3 offset = position - centre_;
    return {offset.dot(x_axis_), offset.dot(y_axis_)};
}

std::optional<KernelRegion> KernelRegion::within(const Stage& stage, const SurfacePoint& centre,
                                                 const Vec3& side, double radius_m) {
    if (centre.object == no_object) return std::nullopt;
    const Shape& shape = stage.parts().objects[centre.object].shape;
    const bool mesh = std::holds_alternative<MeshInstance>(shape);
    if (!mesh && !is_plane(shape, centre.patch)) return std::nullopt;
    KernelRegion region(centre.position, side, radius_m);
    for (const auto& [a, b] : outline_near(shape, centre, radius_m)) {
        region.outline_.push_back({region.local(a), region.local(b)});
    }
    const Vec3 origin = centre.position + height * radius_m * side;
    std::array<Barrier, sectors> met;
    bool any = false;
    for (int i = 0; i < sectors; ++i) {
        const double angle = 2.0 * pi / sectors * (i + 0.5);
        const Vec2 direction(std::cos(angle), std::sin(angle));
        const double reach_m = std::min(radius_m, region.within_outline_m(direction));
        if (!(reach_m > 0.0)) continue;
        const Vec3 along = direction.x() * region.x_axis_ + direction.y() * region.y_axis_;
        const auto hit = stage.caster().intersect({origin, along}, nullptr, reach_m);
        if (!hit) continue;
        any = true;
        const Vec3& n = hit->point.normal;
        Vec2 normal(n.dot(region.x_axis_), n.dot(region.y_axis_));
        if (normal.dot(direction) < 0.0) normal = -normal;
        normal = normal.norm() > least_steepness ? normal.normalized() : direction;
        met[static_cast<std::size_t>(i)] = {normal, hit->distance_m * normal.dot(direction)};
    }
    if (!any || !region.knows_patch(shape, centre)) return std::nullopt;
    // A barrier may reach into a sector whose middle passes it by.
    region.barriers_ = met;
    for (int i = 0; i < sectors; ++i) {
        Barrier& own = region.barriers_[static_cast<std::size_t>(i)];
        for (const int beside : {i + 1, i + sectors - 1}) {
            const Barrier& other = met[static_cast<std::size_t>(beside % sectors)];
            if (own.distance_m == infinity && other.distance_m < infinity) own = other;
        }
    }
    return region;
}

// Whether the patch is, within the radius, what lies on the inner side of each line of the outline.
bool KernelRegion::knows_patch(const Shape& shape, const SurfacePoint& centre) const {
    if (std::holds_alternative<Rectangle>(shape) || std::holds_alternative<Box>(shape)) return true;
    const double kernel_m2 = kernel_area_m2(shape, centre, radius_m_);
    const double disc_m2 = pi * radius_m_ * radius_m_;
    // A whole disc shows that a mesh is flat there. Else the digits of its file decide.
    if (outline_.empty()) return std::abs(kernel_m2 - disc_m2) <= 1e-9 * disc_m2;
    return std::abs(kernel_m2 - area_m2(radius_m_)) <= 1e-6 * disc_m2;  // without barriers yet
}

double KernelRegion::within_outline_m(const Vec2& direction) const {
    double distance_m = infinity;
    for (const auto& [a, b] : outline_) {
        const Vec2 along = b - a;
        const Vec2 across(along.y(), -along.x());
        const double rate = across.dot(direction), offset = across.dot(a);
        if (rate * offset > 0.0) distance_m = std::min(distance_m, offset / rate);
    }
    // What stands at the edge cuts off nothing.
    return distance_m * (1.0 - 1e-6);
}

bool KernelRegion::holds(const Vec3& position) const {
    const Vec2 p = local(position);
    // Four sectors in a quadrant.
    static_assert(sectors == 16);
    const bool left = p.x() < 0.0, below = p.y() < 0.0;
    const double x = std::abs(p.x()), y = std::abs(p.y());
    const bool turned = left != below;  // the quadrant's first axis is then that of y
    const double first = turned ? y : x, second = turned ? x : y;
    constexpr double tangent = std::numbers::sqrt2 - 1.0;  // of a sector's angle
    const std::size_t in_quadrant = (second >= tangent * first ? 1 : 0) +
                                    (second >= first ? 1 : 0) + (tangent * second >= first ? 1 : 0);
    const std::size_t quadrant = below ? (left ? 2 : 3) : (left ? 1 : 0);
    const Barrier& barrier = barriers_[4 * quadrant + in_quadrant];
    return p.dot(barrier.normal) < barrier.distance_m;
}

double KernelRegion::area_m2(double radius_m) const {
    const double far_m = far * radius_m_;
    std::vector<Vec2> polygon;
    for (int i = 0; i < sectors; ++i) {
        const Barrier& barrier = barriers_[static_cast<std::size_t>(i)];
        // Where both edges of the sector meet the barrier, if they do.
        std::array<Vec2, 2> corners;
        std::array<bool, 2> meets{};
        for (std::size_t edge = 0; edge < 2; ++edge) {
            const double angle = 2.0 * pi / sectors * (i + static_cast<int>(edge));
            const Vec2 direction(std::cos(angle), std::sin(angle));
            const double cosine = direction.dot(barrier.normal);
            meets[edge] = cosine * far_m > barrier.distance_m;
            corners[edge] = (meets[edge] ? barrier.distance_m / cosine : far_m) * direction;
        }
        polygon.push_back(corners[0]);
        if (meets[0] != meets[1]) {
            // The barrier leaves the sector at infinity.
            const Vec2 along(-barrier.normal.y(), barrier.normal.x());
            polygon.push_back(meets[0] ? Vec2(corners[0] + far_m * along)
                                       : Vec2(corners[1] - far_m * along));
        }
        polygon.push_back(corners[1]);
    }
    for (const auto& [a, b] : outline_) clip(polygon, a, b);
    return polygon.size() < 3 ? 0.0 : std::abs(disc_polygon_area(polygon, radius_m));
}

}  // namespace lucerna::optics
