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

}  // namespace lucerna::optics
