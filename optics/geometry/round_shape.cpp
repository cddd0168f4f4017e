#include "optics/geometry/round_shape.h"

#include "optics/geometry/disc_area.h"

namespace lucerna::optics::per_shape {

ShapeHit side_hit(const AxialFrame& axial, Vec3 p, double radius_m, double outward, double t,
                  Patch patch) {
    const Vec2 radial = p.head<2>().normalized();
    p << radius_m * radial, std::clamp(p.z(), 0.0, axial.height_m);
    const Vec3 normal =
        outward * (radial.x() * axial.frame.tangent + radial.y() * axial.frame.bitangent);
    return {t, axial.to_world(p), normal, patch, patch};
}

ShapeHit end_hit(const AxialFrame& axial, Vec3 p, double inner_radius_m, double radius_m,
                 bool at_to, double t, Patch patch) {
    const double distance = p.head<2>().norm();
    if (distance > radius_m) p.head<2>() *= radius_m / distance;
    if (distance < inner_radius_m && distance > 0.0) p.head<2>() *= inner_radius_m / distance;
    p.z() = at_to ? axial.height_m : 0.0;
    const Vec3 normal = at_to ? axial.frame.normal : Vec3(-axial.frame.normal);
    return {t, axial.to_world(p), normal, patch, patch};
}

SurfacePoint sample_side(const AxialFrame& axial, double radius_m, double outward, Patch patch,
                         double u1, double u2) {
    const double azimuth = 2.0 * pi * u1;
    const Vec3 radial =
        std::cos(azimuth) * axial.frame.tangent + std::sin(azimuth) * axial.frame.bitangent;
    return {.position = axial.origin + radius_m * radial + u2 * axial.height_m * axial.frame.normal,
            .normal = outward * radial,
            .patch = patch,
            .primitive = patch};
}

SurfacePoint sample_end(const AxialFrame& axial, double inner_radius_m, double radius_m, bool at_to,
                        Patch patch, double u1, double u2) {
    const Vec3 centre = axial.origin + (at_to ? axial.height_m : 0.0) * axial.frame.normal;
    const Vec3 normal = at_to ? axial.frame.normal : Vec3(-axial.frame.normal);
    SurfacePoint p = sample_area(Disk{centre, normal, radius_m, inner_radius_m}, u1, u2);
    p.patch = p.primitive = patch;
    return p;
}

double side_kernel_area_m2(const AxialFrame& axial, double radius_m, const Vec3& p,
                           double kernel_radius_m) {
    // The unrolled side is a rectangle with p half-way round; a larger kernel meets itself behind.
    const double z = (p - axial.origin).dot(axial.frame.normal);
    return disc_rectangle_area(pi * radius_m, z, 2.0 * pi * radius_m, axial.height_m,
                               kernel_radius_m);
}

}  // namespace lucerna::optics::per_shape
