#include "optics/transport/sensor_planes.h"

#include "core/sampling.h"

namespace lucerna::optics {
namespace {

// Distance along a plane to the nearest surface, looked for in directions all around; a straight
// wall is missed by no more than the cosine of half a step, which is allowed for.
double clearance_m(const RayCaster& caster, const Vec3& position, const Vec3& normal,
                   double most_m) {
    constexpr int directions = 64;
    const Frame frame(normal);
    double nearest_m = most_m;
    for (int i = 0; i < directions; ++i) {
        const double angle = 2.0 * pi * i / directions;
        const Ray ray{position, frame.to_world({std::cos(angle), std::sin(angle), 0.0})};
        // What is nearer than rounding is the surface that the point lies on.
        const auto hit = caster.intersect(ray, nullptr);
        if (hit && hit->distance_m > 1e-9 * caster.scene_radius_m()) {
            nearest_m = std::min(nearest_m, hit->distance_m);
        }
    }
    return nearest_m * std::cos(pi / directions);
}

}  // namespace

SensorPlanes::SensorPlanes(const SceneParts& parts, const RayCaster& caster, double margin_m)
    : margin_m_(margin_m), points_(parts.observers.size()) {
    for (std::size_t i = 0; i < parts.observers.size(); ++i) {
        const auto* points = std::get_if<IlluminancePoints>(&parts.observers[i]);
        if (!points) continue;
        const std::size_t first = planes_.size();
        for (const Vec3& position : points->positions) {
            const double offset_m = position.dot(points->normal);
            std::size_t plane = first;
            while (plane < planes_.size() &&
                   std::abs(planes_[plane].offset_m - offset_m) > 1e-9 * (1.0 + position.norm())) {
                ++plane;
            }
            if (plane == planes_.size()) planes_.push_back({points->normal, offset_m, {}});
            planes_[plane].bounds.extend(position);
            points_[i].push_back({position, static_cast<std::uint32_t>(plane),
                                  clearance_m(caster, position, points->normal, margin_m),
                                  point_count_++});
        }
    }
}

std::vector<SensorPlanes::Point> SensorPlanes::points_of(std::uint32_t plane) const {
    std::vector<Point> points;
    for (const auto& of_observer : points_) {
        for (const Point& point : of_observer) {
            if (point.plane == plane) points.push_back(point);
        }
    }
    return points;
}

}  // namespace lucerna::optics
