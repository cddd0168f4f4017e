#include "optics/light/spherical_rectangle.h"

#include <algorithm>
#include <complex>

namespace lucerna::optics {
namespace {

// Squared diagonal over squared distance from the centre. Points of a rectangle that looks smaller
// lie within 0.6 and 1.4 distances; by its area alone a long lamp would pass for small beside its
// end, where the nearest points outweigh all others.
constexpr double small_diagonal2_by_distance2 = 0.6;
// The solid angle is known to some 1e-15 sr.
constexpr double least_solid_angle_sr = 1e-7;

// z component of the unit vector along (0, z, -a).
double normal_z(double a, double z) {
    return -a / std::sqrt(z * z + a * a);
}

// Of what is positive but for rounding, to divide by.
double root(double x) {
    return std::sqrt(std::max(x, 1e-300));
}

// exp(i g) for the angle g between two neighbouring planes, by the z components of their normals,
// which are perpendicular to x and y: cos g = -n m, and the square of the sine without
// cancellation.
std::complex<double> corner(double n, double m) {
    return {-n * m, std::sqrt((1.0 - n) * (1.0 + n) + n * n * (1.0 - m) * (1.0 + m))};
}

}  // namespace

std::optional<SphericalRectangle> SphericalRectangle::seen_from(const Vec3& x,
                                                                const Rectangle& rectangle) {
    const Vec3 to_corner = rectangle.corner - x;
    const double width2_m2 = rectangle.edge_u.squaredNorm();
    const double height2_m2 = rectangle.edge_v.squaredNorm();
    const double distance2_m2 =
        (to_corner + 0.5 * (rectangle.edge_u + rectangle.edge_v)).squaredNorm();
    if (width2_m2 + height2_m2 < small_diagonal2_by_distance2 * distance2_m2) return std::nullopt;

    SphericalRectangle seen;
    seen.rectangle_ = &rectangle;
    seen.width_m_ = std::sqrt(width2_m2);
    seen.height_m_ = std::sqrt(height2_m2);
    seen.x0_ = to_corner.dot(rectangle.edge_u) / seen.width_m_;
    seen.x1_ = seen.x0_ + seen.width_m_;
    seen.y0_ = to_corner.dot(rectangle.edge_v) / seen.height_m_;
    seen.y1_ = seen.y0_ + seen.height_m_;
    seen.z_ = -std::abs(to_corner.dot(rectangle.edge_u.cross(rectangle.edge_v))) /
              (seen.width_m_ * seen.height_m_);
    if (!(seen.z_ < 0.0)) return std::nullopt;
    seen.normal_y0_ = normal_z(seen.y0_, seen.z_);
    seen.normal_y1_ = -normal_z(seen.y1_, seen.z_);
    const double normal_x0 = normal_z(seen.x0_, seen.z_);
    const double normal_x1 = -normal_z(seen.x1_, seen.z_);
    // Angles between neighbouring planes; their sum exceeds that of a flat rectangle by the solid
    // angle (Girard). As unit numbers: their products have the sums of the angles, without an arc
    // cosine for each.
    const std::complex first =
        corner(seen.normal_y0_, normal_x1) * corner(normal_x1, seen.normal_y1_);
    const std::complex last =
        corner(seen.normal_y1_, normal_x0) * corner(normal_x0, seen.normal_y0_);
    seen.from_k_ = std::conj(last);
    const double excess = std::arg(first * last);  // over a whole turn
    if (std::abs(excess) < least_solid_angle_sr) return std::nullopt;
    seen.solid_angle_sr_ = excess < 0.0 ? excess + 2.0 * pi : excess;
    return seen;
}

Vec3 SphericalRectangle::sample(double u1, double u2) const {
    // Which x cuts off the share u1 of the solid angle, and along the arc above it which y.
    const std::complex turn = std::polar(1.0, u1 * solid_angle_sr_) * from_k_;
    const double f = turn.real() * normal_y0_ - normal_y1_;
    const double s = turn.imag();
    // c_u of section 4 is +-s over the root of f^2 + (n s)^2; x = -z c_u / sqrt(1 - c_u^2).
    const double root_of_difference = root(square(f) - square(s) * (1.0 - square(normal_y0_)));
    const double x = std::clamp(-z_ * std::copysign(1.0, f) * s / root_of_difference, x0_, x1_);
    const double d = std::sqrt(x * x + z_ * z_);
    const double h0 = y0_ / std::sqrt(d * d + y0_ * y0_);
    const double h1 = y1_ / std::sqrt(d * d + y1_ * y1_);
    const double h = h0 + u2 * (h1 - h0);
    const double y = std::clamp(h * d / root(1.0 - h * h), y0_, y1_);
    return rectangle_->corner + (x - x0_) / width_m_ * rectangle_->edge_u +
           (y - y0_) / height_m_ * rectangle_->edge_v;
}

}  // namespace lucerna::optics
