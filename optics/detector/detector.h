// Observers, traced backward from where they look, and receivers, counted by forward rays.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "core/vector.h"
#include "optics/geometry/shape.h"

namespace lucerna::optics {

/// Perspective camera with square pixels; measures luminance per pixel (box filter).
struct Camera {
    std::string name;
    Vec3 from, to, up;
    double horizontal_fov_rad;
    int width, height;
};

/// The rays of a camera, with what they share computed once.
class CameraRays {
public:
    explicit CameraRays(const Camera& camera);

    /// Through a point of the image plane; x right from 0 to width, y down from 0 to height.
    Ray through(double x, double y) const;
    /// Area of a small surface that one pixel sees [m2]: where the light of a pixel comes from.
    /// @param position  in front of the camera, in view.
    double seen_by_pixel_m2(const Vec3& position, const Vec3& normal) const;

private:
    Vec3 origin_, forward_, right_, upward_;
    double half_width_;  // of the image plane at distance 1; pixels are square
    int width_, height_;
};

/// Illuminance at points [lx]: E = integral of L cos over the hemisphere around the normal.
/// A point is not a surface and blocks no light.
struct IlluminancePoints {
    std::string name;
    std::vector<Vec3> positions;
    Vec3 normal;
    int columns = 0, rows = 0;  ///< of a regular grid, row by row; 0 for single points
};

/// Mean luminance within a cone, as a spot meter reads it [cd/m2].
struct LuminanceMeter {
    std::string name;
    Vec3 position, direction;
    double acceptance_half_angle_rad;
};

/// Flux that arrives on the surface of an object [lm], counted before any interaction there, from
/// both sides apart. A receiver may also be a virtual sheet that lets light pass (see Object).
struct FluxReceiver {
    std::string name;
    ObjectId object;
};

using Observer = std::variant<Camera, IlluminancePoints, LuminanceMeter>;

}  // namespace lucerna::optics
