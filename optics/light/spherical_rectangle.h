// A rectangle as seen from a point: sampled uniformly per solid angle.
#pragma once

#include <complex>
#include <optional>

#include "core/vector.h"
#include "optics/geometry/shape.h"

namespace lucerna::optics {

/// The part of the unit sphere around a point that a rectangle covers, for points from which it
/// looks large. C. Ureña, M. Fajardo and A. King, "An Area-Preserving Parametrization for Spherical
/// Rectangles", Computer Graphics Forum 32(4), 2013.
class SphericalRectangle {
public:
    /// Nothing where points that are uniform over the area serve as well, since distance and slope
    /// hardly differ between them, and where the rectangle is seen so flat that rounding matters.
    static std::optional<SphericalRectangle> seen_from(const Vec3& x, const Rectangle& rectangle);

    double solid_angle_sr() const { return solid_angle_sr_; }
    /// Point of the rectangle, uniform per solid angle.
    Vec3 sample(double u1, double u2) const;

private:
    SphericalRectangle() = default;

    const Rectangle* rectangle_ = nullptr;
    // In the frame of the rectangle with x at its origin: from (x0, y0) to (x1, y1), below x.
    double x0_ = 0.0, x1_ = 0.0, y0_ = 0.0, y1_ = 0.0, z_ = 0.0;
    double width_m_ = 0.0, height_m_ = 0.0;
    // z components of the normals of the planes through x and the edges y0 and y1; exp(i k) with k
    // of section 4.
    double normal_y0_ = 0.0, normal_y1_ = 0.0;
    std::complex<double> from_k_;
    double solid_angle_sr_ = 0.0;
};

}  // namespace lucerna::optics
