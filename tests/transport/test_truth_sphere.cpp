// Integrating spheres and spherical lamps.
#include "tests/support/truth_checks.h"

using namespace lucerna;
using namespace lucerna::optics;
using validation::SceneBuilder;

namespace {

constexpr double radius_m = 0.5;
constexpr double flux_lm = 1000.0;
const double wall_area_m2 = 4.0 * pi * radius_m * radius_m;

}  // namespace

TEST_CASE("Integrating sphere: a point source off its centre", "[analytic]") {
    // Each piece of a sphere's wall lights all others alike, so that the reflected part is uniform:
    // E = Phi cos / (4 pi d^2) + Phi rho / (A (1 - rho)), and L = rho E / pi.
    const auto [rho, method] = GENERATE(table<double, Method>({{0.5, Method::combined},
                                                               {0.5, Method::forward},
                                                               {0.5, Method::backward},
                                                               {0.5, Method::path},
                                                               {0.95, Method::combined}}));
    INFO("rho " << rho << " method " << static_cast<int>(method));
    SceneBuilder scene;
    const ObjectId wall = scene.object("wall", Sphere{Vec3::Zero(), radius_m}, scene.diffuse(rho));
    const Vec3 lamp(0.0, 0.0, 0.2);
    scene.light("lamp", PointLight{lamp}, flux_lm);
    scene.receiver(wall);
    // The meter looks from the centre at the far pole; a map gathered where it is seen needs many
    // kernels in view.
    const double half_angle_rad = method == Method::forward ? 1.2 : 0.4;
    scene.meter(Vec3::Zero(), {0.0, 0.0, -1.0}, half_angle_rad);
    if (method != Method::forward) scene.points({{0.0, 0.0, -0.3}}, Vec3::UnitZ());
    const Result result = test::run(scene, method,
                                    {160, rho > 0.9                   ? 3000u
                                          : method == Method::forward ? 30000u
                                                                      : 6000u});

    const double reflected = flux_lm * rho / (wall_area_m2 * (1.0 - rho));
    // Direct light over the cap by Gauss's law: the flux within the cone of the lamp through the
    // rim of the cap, spread over the cap.
    const double rim_z = -radius_m * std::cos(half_angle_rad) - lamp.z();
    const double rim_x = radius_m * std::sin(half_angle_rad);
    const double share = 0.5 * (1.0 - std::abs(rim_z) / std::hypot(rim_x, rim_z));
    const double cap_area = 2.0 * pi * radius_m * radius_m * (1.0 - std::cos(half_angle_rad));
    const double luminance = rho / pi * (flux_lm * share / cap_area + reflected);
    test::check_truth(result.quantities[0].estimate, luminance);
    test::check_refutes(result.quantities[0].estimate,
                        luminance - rho / pi * reflected * (1.0 - rho));
    if (method != Method::forward) {
        // Light of the lamp, and a uniform field of the reflected light and of the direct light
        // that the walls reflect: not the same above and below, but over the hemisphere.
        const Estimate& estimate = result.quantities[1].estimate;
        const double direct = flux_lm / (4.0 * pi * 0.25);
        const auto wall_luminance = [&](const Vec3& x) {
            const Vec3 way = x - lamp;
            const double cosine = way.dot(x) / (way.norm() * radius_m);
            return rho / pi * (flux_lm * cosine / (4.0 * pi * way.squaredNorm()) + reflected);
        };
        // E = integral of L cos over the upper hemisphere at (0, 0, -0.3), midpoint in cos^2.
        constexpr int steps = 2000;
        double field = 0.0;
        for (int i = 0; i < steps; ++i) {
            const double square = (i + 0.5) / steps;
            const Vec3 w(std::sqrt(1.0 - square), 0.0, std::sqrt(square));
            const Vec3 x0(0.0, 0.0, -0.3);
            const double b = x0.dot(w);
            const double t = -b + std::sqrt(b * b - x0.squaredNorm() + radius_m * radius_m);
            field += pi / steps * wall_luminance(x0 + t * w);
        }
        test::check_truth(estimate, direct + field);
        test::check_refutes(estimate, direct + field / pi);
    }
    const Estimate& received = result.quantities.back().estimate;  // on the inner side
    test::check_truth(received, flux_lm / (1.0 - rho));
    CHECK(result.quantities[result.quantities.size() - 2].estimate.mean() == 0.0);  // outer side
}

TEST_CASE("Integrating sphere: two point sources, and twelve", "[analytic]") {
    // On the axis of the cap that the meter sees; at the second event one of them is tested for
    // shadows, and of more than eight a few are drawn.
    const int lamps = GENERATE(2, 12);
    const auto method = GENERATE(Method::combined, Method::backward);
    INFO(lamps << " lamps, method " << static_cast<int>(method));
    constexpr double rho = 0.5, half_angle_rad = 0.4;
    SceneBuilder scene;
    scene.object("wall", Sphere{Vec3::Zero(), radius_m}, scene.diffuse(rho));
    scene.meter(Vec3::Zero(), {0.0, 0.0, -1.0}, half_angle_rad);
    double all_lm = 0.0;
    double on_cap_lm = 0.0;
    for (int i = 0; i < lamps; ++i) {
        const double z = 0.3 - 0.5 * i / lamps;
        const double lamp_lm = flux_lm * (i + 1);
        scene.light("lamp", PointLight{Vec3(0.0, 0.0, z)}, lamp_lm);
        all_lm += lamp_lm;
        const double rim_z = -radius_m * std::cos(half_angle_rad) - z;
        const double rim_x = radius_m * std::sin(half_angle_rad);
        on_cap_lm += lamp_lm * 0.5 * (1.0 - std::abs(rim_z) / std::hypot(rim_x, rim_z));
    }
    const double cap_m2 = 2.0 * pi * radius_m * radius_m * (1.0 - std::cos(half_angle_rad));
    const double reflected = all_lm * rho / (wall_area_m2 * (1.0 - rho));
    const double luminance = rho / pi * (on_cap_lm / cap_m2 + reflected);
    const Result result = test::run(scene, method, {200, 4000});
    test::check_truth(result.quantities[0].estimate, luminance);
    // Without the light that was reflected once on its way to the cap.
    test::check_refutes(result.quantities[0].estimate,
                        luminance - rho / pi * all_lm * rho / wall_area_m2);
}

TEST_CASE("Integrating sphere: a lamp that absorbs and reflects", "[analytic]") {
    // A sphere of radius a in the centre takes the share f = (a / R)^2 of what the wall sends out
    // and returns the share r of it to the wall: E = Phi / (A (1 - rho (1 - f) - rho f r)).
    const auto method = GENERATE(Method::combined, Method::forward);
    const double rho = 0.9;
    const double lamp_rho = 0.4;
    const double lamp_radius_m = 0.15;
    SceneBuilder scene;
    const ObjectId wall = scene.object("wall", Sphere{Vec3::Zero(), radius_m}, scene.diffuse(rho));
    const ObjectId lamp =
        scene.object("lamp", Sphere{Vec3::Zero(), lamp_radius_m}, scene.diffuse(lamp_rho));
    scene.light("lamp", AreaLight{lamp, scene.parts.objects[lamp].shape}, flux_lm);
    scene.receiver(wall);
    scene.receiver(lamp);
    scene.meter({0.3, 0.0, 0.0}, {0.5, 0.2, 0.0}, 1.2);
    INFO("method " << static_cast<int>(method));
    const Result result = test::run(scene, method, {180, 6000});
    const double share = std::pow(lamp_radius_m / radius_m, 2);
    const double illuminance =
        flux_lm / (wall_area_m2 * (1.0 - rho * (1.0 - share) - rho * share * lamp_rho));
    test::check_truth(result.quantities[0].estimate, rho * illuminance / pi);
    test::check_refutes(result.quantities[0].estimate,
                        rho / pi * flux_lm / (wall_area_m2 * (1.0 - rho)));
    test::check_truth(result.quantities[2].estimate, illuminance * wall_area_m2);
    test::check_truth(result.quantities[3].estimate, illuminance * wall_area_m2 * rho * share);
}

TEST_CASE("Spherical lamp: E = pi L (R / d)^2 cos", "[analytic]") {
    const auto method = GENERATE(Method::combined, Method::path);
    const double luminance = 5000.0;
    SceneBuilder scene;
    const Vec3 centre(0.2, -0.1, 1.5);
    scene.area_light(scene.object("lamp", Sphere{centre, 0.25}, scene.black()), luminance);
    const std::vector<Vec3> positions{{0.2, -0.1, 0.0}, {1.2, 0.4, 0.0}, {0.2, -0.1, 1.2}};
    scene.points(positions, Vec3::UnitZ());
    const Result result = test::run(scene, method, {64, 100});
    for (std::size_t i = 0; i < positions.size(); ++i) {
        const Vec3 way = centre - positions[i];
        const double truth =
            pi * luminance * 0.25 * 0.25 / way.squaredNorm() * way.z() / way.norm();
        test::check_truth(result.quantities[i].estimate, truth);
        test::check_refutes(result.quantities[i].estimate, truth / pi);
    }
}
