#include "optics/transport/sensor_planes.h"

namespace lucerna::optics {

SensorPlanes::SensorPlanes(const SceneParts& parts, double margin_m)
    : margin_m_(margin_m), plane_of_(parts.observers.size()) {
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
            plane_of_[i].push_back(static_cast<std::uint32_t>(plane));
        }
    }
}

}  // namespace lucerna::optics
