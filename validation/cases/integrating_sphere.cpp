// Integrating spheres: each piece of a sphere's wall lights all others alike, so that the reflected
// part of the illuminance of the wall is uniform.
#include <fmt/format.h>

#include "validation/cases.h"
#include "validation/scene_builder.h"
#include "validation/truth/quadrature.h"

namespace lucerna::validation {
namespace {

using namespace optics;

constexpr double radius_m = 0.5;
const double wall_area_m2 = 4.0 * pi * radius_m * radius_m;

// E = Phi cos / (4 pi d^2) + Phi rho / (A (1 - rho)), and L = rho E / pi.
// @param lamp_m, point_m  heights above the centre; the point is the lower one.
Case off_centre(const std::string& id, double rho, double lamp_m, double point_m,
                double half_angle_rad, const optics::Settings& settings) {
    SceneBuilder scene;
    const ObjectId wall = scene.object("wall", Sphere{Vec3::Zero(), radius_m}, scene.diffuse(rho));
    const Vec3 lamp(0.0, 0.0, lamp_m);
    scene.light("lamp", PointLight{lamp}, lamp_flux_lm);
    scene.receiver(wall);
    scene.meter(Vec3::Zero(), {0.0, 0.0, -1.0}, half_angle_rad);  // at the far pole
    const Vec3 point(0.0, 0.0, point_m);
    scene.points({point}, Vec3::UnitZ());

    const double reflected = lamp_flux_lm * rho / (wall_area_m2 * (1.0 - rho));
    // The meter sees a cap. Direct light on it by Gauss's law: the flux within the cone of the lamp
    // through the rim of the cap, spread over the cap. Seen from the centre, equal areas of the cap
    // take equal solid angles.
    const double rim_z = -radius_m * std::cos(half_angle_rad) - lamp.z();
    const double rim_x = radius_m * std::sin(half_angle_rad);
    const double share = 0.5 * (1.0 - std::abs(rim_z) / std::hypot(rim_x, rim_z));
    const double cap_area = 2.0 * pi * radius_m * radius_m * (1.0 - std::cos(half_angle_rad));
    const double luminance = rho / pi * (lamp_flux_lm * share / cap_area + reflected);
    // At the point: light of the lamp, and of the wall above its horizon.
    const double direct = lamp_flux_lm / (4.0 * pi * (lamp - point).squaredNorm());
    const auto wall_luminance = [&](const Vec3& x) {
        const Vec3 way = x - lamp;
        const double cosine = way.dot(x) / (way.norm() * radius_m);
        return rho / pi * (lamp_flux_lm * cosine / (4.0 * pi * way.squaredNorm()) + reflected);
    };
    // E = pi * integral over cos^2 from 0 to 1 of the luminance in that direction.
    const double field = pi * truth::integral(
                                  [&](double square) {
                                      const Vec3 w(std::sqrt(1.0 - square), 0.0, std::sqrt(square));
                                      const double b = point.dot(w);
                                      const double t = -b + std::sqrt(b * b - point.squaredNorm() +
                                                                      radius_m * radius_m);
                                      return wall_luminance(point + t * w);
                                  },
                                  0.0, 1.0, 64);
    return {
        id,
        fmt::format("point source off the centre of a sphere of reflectance {:g}", rho),
        "E = Phi cos/(4 pi d^2) + Phi rho/(A (1 - rho)): the form factor between all pieces of a "
        "sphere is the same, the rest is an energy balance; field at the point by quadrature",
        scene.parts,
        settings,
        {{"wall at the far pole", "luminance", "cd/m2", luminance, 0.0, sensor(0), 0.01},
         {"point within", "illuminance", "lx", direct + field, 1e-6 * field, sensor(1), 0.01},
         {"all of the wall", "luminous flux", "lm", lamp_flux_lm / (1.0 - rho), 0.0, sensor(3),
          0.01}}};
}

// A sphere of radius a in the centre takes the share f = (a / R)^2 of what the wall sends out and
// returns the share r of it to the wall: E = Phi / (A (1 - rho (1 - f) - rho f r)).
Case lamp_in_the_centre(const std::string& id, double rho, double lamp_rho) {
    constexpr double lamp_radius_m = 0.15;
    SceneBuilder scene;
    const ObjectId wall = scene.object("wall", Sphere{Vec3::Zero(), radius_m}, scene.diffuse(rho));
    const ObjectId lamp =
        scene.object("lamp", Sphere{Vec3::Zero(), lamp_radius_m}, scene.diffuse(lamp_rho));
    scene.light("lamp", AreaLight{lamp, scene.parts.objects[lamp].shape}, lamp_flux_lm);
    scene.receiver(wall);
    scene.receiver(lamp);
    scene.meter({0.3, 0.0, 0.0}, {0.5, 0.2, 0.0}, 1.0);
    const double share = std::pow(lamp_radius_m / radius_m, 2);
    const double illuminance =
        lamp_flux_lm / (wall_area_m2 * (1.0 - rho * (1.0 - share) - rho * share * lamp_rho));
    return {
        id,
        fmt::format("lamp of reflectance {:g} in the centre of a sphere of {:g}", lamp_rho, rho),
        "E = Phi/(A (1 - rho (1 - f) - rho f r)), f = (a/R)^2: balance of two concentric spheres, "
        "f by reciprocity",
        scene.parts,
        effort(96, 6000),
        {{"wall", "luminance", "cd/m2", rho * illuminance / pi, 0.0, sensor(0), 0.01},
         {"all of the wall", "luminous flux", "lm", illuminance * wall_area_m2, 0.0, sensor(2),
          0.01},
         {"all of the lamp", "luminous flux", "lm", illuminance * wall_area_m2 * rho * share, 0.0,
          sensor(3), 0.01}}};
}

}  // namespace

std::vector<Case> integrating_sphere_cases() {
    return {off_centre("integrating_sphere/0.5", 0.5, 0.2, -0.3, 0.4, effort(96, 6000)),
            off_centre("integrating_sphere/0.95", 0.95, 0.2, -0.3, 0.4, effort(96, 3000)),
            lamp_in_the_centre("integrating_sphere/black-lamp", 0.9, 0.0),
            lamp_in_the_centre("integrating_sphere/grey-lamp", 0.9, 0.4)};
}

Case drawn_integrating_sphere(const std::string& id, Draw& draw) {
    const double rho = draw.between(0.1, 0.97);
    const double lamp_m = draw.between(-0.6, 0.8) * radius_m;
    const double point_m = draw.between(-0.95 * radius_m, lamp_m - 0.1 * radius_m);
    return off_centre(id, rho, lamp_m, point_m, draw.between(0.05, 0.8), {});
}

}  // namespace lucerna::validation
