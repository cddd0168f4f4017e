#include "optics/detector/detector.h"

namespace lucerna::optics {

CameraRays::CameraRays(const Camera& camera)
    : origin_(camera.from),
      forward_((camera.to - camera.from).normalized()),
      right_(forward_.cross(camera.up).normalized()),
      upward_(right_.cross(forward_)),
      half_width_(std::tan(camera.horizontal_fov_rad / 2.0)),
      width_(camera.width),
      height_(camera.height) {}

Ray CameraRays::through(double x, double y) const {
    const double across = (2.0 * x / width_ - 1.0) * half_width_;
    const double along = (1.0 - 2.0 * y / height_) * half_width_ * height_ / width_;
    return {origin_, (forward_ + across * right_ + along * upward_).normalized()};
}

double CameraRays::seen_by_pixel_m2(const Vec3& position, const Vec3& normal) const {
    // The pixel's side at distance 1 is s; at an angle a off the axis it has the solid angle
    // s^2 cos^3 a, which sees the area d^2 / cos b of a surface tilted by b at distance d.
    const Vec3 way = position - origin_;
    const double depth_m = way.dot(forward_);
    const double side = 2.0 * half_width_ / width_;
    return side * side * depth_m * depth_m * depth_m / std::abs(way.dot(normal));
}

}  // namespace lucerna::optics
