#include "optics/material/ggx.h"

#include <algorithm>
#include <cmath>

namespace lucerna::optics {

double Ggx::facet_density(const Vec3& m) const {
    // Walter 2007, eq. 33, as the area element of the ellipsoid x^2 + y^2 + alpha^2 z^2.
    const double a2 = square(alpha_);
    const double q = (square(m.x()) + square(m.y())) / a2 + square(m.z());
    return 1.0 / (pi * a2 * square(q));
}

double Ggx::lambda(const Vec3& w) const {
    const double tan2 = (square(w.x()) + square(w.y())) / square(w.z());
    return 0.5 * (std::sqrt(1.0 + square(alpha_) * tan2) - 1.0);  // Heitz 2014, eq. 72
}

double Ggx::visible_share_opposite_sides(const Vec3& a, const Vec3& b) const {
    return std::beta(1.0 + lambda(a), 1.0 + lambda(b));
}

double Ggx::visible_density(const Vec3& w, const Vec3& m) const {
    return visible_share(w) * std::max(0.0, w.dot(m)) * facet_density(m) / w.z();
}

Vec3 Ggx::sample_visible(const Vec3& w, double u1, double u2) const {
    // Stretched by alpha, the facets become a hemisphere; its part seen from v projects to a half
    // disk and a half ellipse, which are sampled by area (Heitz 2018, section 3).
    const Vec3 v = Vec3(alpha_ * w.x(), alpha_ * w.y(), w.z()).normalized();
    const double sin2 = square(v.x()) + square(v.y());
    const Vec3 t1 = sin2 > 0.0 ? Vec3(Vec3(-v.y(), v.x(), 0.0) / std::sqrt(sin2)) : Vec3::UnitX();
    const Vec3 t2 = v.cross(t1);
    const double radius = std::sqrt(u1);
    const double p1 = radius * std::cos(2.0 * pi * u2);
    const double p2_disk = radius * std::sin(2.0 * pi * u2);
    const double s = 0.5 * (1.0 + v.z());
    const double p2 = (1.0 - s) * std::sqrt(std::max(0.0, 1.0 - square(p1))) + s * p2_disk;
    const Vec3 m = p1 * t1 + p2 * t2 + std::sqrt(std::max(0.0, 1.0 - square(p1) - square(p2))) * v;
    return Vec3(alpha_ * m.x(), alpha_ * m.y(), std::max(0.0, m.z())).normalized();
}

}  // namespace lucerna::optics
