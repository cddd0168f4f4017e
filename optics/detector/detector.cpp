#include "optics/detector/detector.h"

namespace lucerna::optics {

Ray Camera::ray(double x, double y) const {
    const Vec3 forward = (to - from).normalized();
    const Vec3 right = forward.cross(up).normalized();
    const Vec3 upward = right.cross(forward);
    // Half the width of the image plane at distance 1; pixels are square.
    const double half_width = std::tan(horizontal_fov_rad / 2.0);
    const double across = (2.0 * x / width - 1.0) * half_width;
    const double along = (1.0 - 2.0 * y / height) * half_width * height / width;
    return {from, (forward + across * right + along * upward).normalized()};
}

}  // namespace lucerna::optics
