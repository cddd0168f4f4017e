// Direct light of rectangles and of measured luminaires, and absorption on its way.
#include "tests/support/truth_checks.h"
#include "validation/truth/luminaire.h"
#include "validation/truth/polygon_light.h"
#include "validation/truth/quadrature.h"

using namespace lucerna;
using namespace lucerna::optics;
using truth::polygon_illuminance;
using truth::total_flux_lm;
using validation::SceneBuilder;

namespace {

// Turned by 25 deg about the vertical, then its C = 0 side lifted by 15 deg.
const truth::Axes luminaire_axes = truth::axes(25.0, 15.0);

double intensity_toward(const Vec3& direction) {
    return truth::intensity_toward(luminaire_axes, direction);
}

Luminaire luminaire(const Vec3& position) {
    Luminaire light;
    light.position = position;
    const truth::Axes& a = luminaire_axes;
    light.to_photometric.row(0) = a.c0.transpose();
    light.to_photometric.row(1) = a.c90.transpose();
    light.to_photometric.row(2) = a.up.transpose();
    light.intensity = std::make_shared<const IntensityDistribution>(truth::c_deg, truth::gamma_deg,
                                                                    truth::table_cd);
    return light;
}

const std::vector<Vec3> floor_points{
    {0.0, 0.0, 0.0}, {1.0, 0.5, 0.0}, {-1.2, 0.3, 0.0}, {0.4, -1.5, 0.0}};

}  // namespace

TEST_CASE("Direct light: a square luminaire by Lambert's formula", "[analytic]") {
    const auto method = GENERATE(Method::combined, Method::forward, Method::path);
    const double luminance = 2000.0;
    const double rho = 0.4;
    SceneBuilder scene;
    const Vec3 corner(-0.3, -0.5, 1.5);
    const Vec3 u(0.0, 1.0, 0.0);
    const Vec3 v(0.8, 0.0, 0.0);
    scene.area_light(scene.object("lamp", Rectangle{corner, u, v}, scene.black()), luminance);
    scene.object("floor", Rectangle{{-5, -5, 0}, {10, 0, 0}, {0, 10, 0}}, scene.diffuse(rho));
    scene.points(floor_points, Vec3::UnitZ());
    for (const Vec3& point : floor_points) scene.meter({0.2, 0.2, 1.0}, point, 0.01);
    const auto polygon = truth::corners(corner, u, v);
    const Result result = test::run(scene, method, {64, 100});
    INFO("method " << static_cast<int>(method));
    for (std::size_t i = 0; i < floor_points.size(); ++i) {
        const double truth =
            polygon_illuminance(polygon, luminance, floor_points[i], Vec3::UnitZ());
        test::check_truth(result.quantities[i].estimate, truth);
        test::check_refutes(result.quantities[i].estimate, 1.02 * truth);
        test::check_truth(result.quantities[4 + i].estimate, rho / pi * truth);
        test::check_refutes(result.quantities[4 + i].estimate, rho * truth);
    }
}

TEST_CASE("Direct light: a coated floor that mirrors a lamp", "[analytic]") {
    const auto method = GENERATE(Method::combined, Method::forward, Method::path);
    const double luminance = 2000.0, rho = 0.5, mirror_rho = 0.9;
    const double weight_of_paint = 0.9, weight_of_coat = 0.08;
    const Vec3 ex = Vec3::UnitX(), ey = Vec3::UnitY(), ez = Vec3::UnitZ();
    const Vec3 corner(-0.4, -0.4, 1.5), target = Vec3::Zero();
    SceneBuilder scene;
    scene.area_light(scene.object("lamp", Rectangle{corner, 0.8 * ey, 0.8 * ex}, scene.black()),
                     luminance);
    const BsdfId paint = scene.diffuse(rho), coat = scene.mirror(mirror_rho);
    scene.object(
        "floor", Rectangle{{-2, -2, 0}, 4 * ex, 4 * ey},
        scene.parts.add(Bsdf{Mixture{{{weight_of_paint, paint}, {weight_of_coat, coat}}}}));
    scene.meter({0.1, 0.1, 1.2}, target, 0.01);
    const double mirrored = weight_of_coat * mirror_rho * luminance;
    const double scattered =
        weight_of_paint * rho / pi *
        polygon_illuminance(truth::corners(corner, 0.8 * ey, 0.8 * ex), luminance, target, ez);
    INFO("method " << static_cast<int>(method));
    const Estimate estimate = test::run(scene, method, {64, 100}).quantities.front().estimate;
    test::check_truth(estimate, mirrored + scattered);
    test::check_refutes(estimate, 1.05 * mirrored + scattered);
    test::check_refutes(estimate, mirrored + 1.05 * scattered);
}

TEST_CASE("Direct light: more lights than are drawn at once", "[analytic]") {
    // Of many lights only some are drawn, by their flux: points, and two panels by Lambert's
    // formula.
    const auto method = GENERATE(Method::combined, Method::path);
    SceneBuilder scene;
    const auto polygon_1 = truth::corners({-0.3, -0.5, 1.5}, {0, 1, 0}, {0.8, 0, 0});
    const auto polygon_2 = truth::corners({-1.5, -0.5, 1.2}, {0, 0.3, 0}, {0.3, 0, 0});
    const Rectangle panel_1{polygon_1[0], {0, 1, 0}, {0.8, 0, 0}};
    const Rectangle panel_2{polygon_2[0], {0, 0.3, 0}, {0.3, 0, 0}};
    scene.area_light(scene.object("lamp", panel_1, scene.black()), 2000.0);
    scene.area_light(scene.object("small", panel_2, scene.black()), 8000.0);
    std::vector<double> truths(floor_points.size());
    for (std::size_t i = 0; i < floor_points.size(); ++i) {
        truths[i] = polygon_illuminance(polygon_1, 2000.0, floor_points[i], Vec3::UnitZ()) +
                    polygon_illuminance(polygon_2, 8000.0, floor_points[i], Vec3::UnitZ());
    }
    for (int k = 0; k < 10; ++k) {
        const double flux_lm = 300.0 * (k + 1);
        const Vec3 position(std::cos(k), std::sin(k), 0.7 + 0.04 * k);  // below the panels
        scene.light("point", PointLight{position}, flux_lm);
        for (std::size_t i = 0; i < floor_points.size(); ++i) {
            const Vec3 to_light = position - floor_points[i];
            truths[i] += flux_lm / (4.0 * pi) * to_light.z() / std::pow(to_light.norm(), 3);
        }
    }
    scene.object("floor", Rectangle{{-5, -5, 0}, {10, 0, 0}, {0, 10, 0}}, scene.diffuse(0.4));
    scene.points(floor_points, Vec3::UnitZ());
    const Result result = test::run(scene, method, {32, 100});
    for (std::size_t i = 0; i < floor_points.size(); ++i) {
        test::check_truth(result.quantities[i].estimate, truths[i]);
        test::check_refutes(result.quantities[i].estimate, 1.02 * truths[i]);
    }
}

TEST_CASE("Direct light: a disk from nearby and from far away", "[analytic]") {
    // Within three of its radii scattered rays look for it too; from further away, and where no ray
    // need go on for other light, sampled points of it are all.
    const auto method = GENERATE(Method::combined, Method::forward, Method::path);
    const double luminance = 3000.0;
    const double radius_m = 0.2;
    const double rho = 0.6;
    SceneBuilder scene;
    scene.area_light(scene.object("lamp", Disk{{0, 0, 1}, -Vec3::UnitZ(), radius_m}, scene.black()),
                     luminance);
    const std::vector<Vec3> positions{{0.1, 0, 0.9}, {-0.5, 0, 0.7}, {0.6, 0, 0.6}, {0, 0.9, 0.2}};
    scene.points(positions, Vec3::UnitZ());
    const std::vector<Vec3> papers{{-0.2, 0.1, 0.8}, {0.7, 0.2, 0.5}};
    for (const Vec3& at : papers) {
        scene.object("paper", Disk{at, Vec3::UnitZ(), 0.01}, scene.diffuse(rho));
        scene.meter(at + Vec3(0.2, 0.2, 0.1), at, 0.002);
    }
    const Result result = test::run(scene, method, {64, 1000});
    INFO("method " << static_cast<int>(method));
    // E of a disk on a parallel plane, off its axis by a (Foote 1915; factor B-13 of Howell's
    // catalogue).
    const auto illuminance = [&](const Vec3& x) {
        const double a2 = x.x() * x.x() + x.y() * x.y();
        const double sum = square(1.0 - x.z()) + a2 + square(radius_m);
        return 0.5 * pi * luminance *
               (1.0 - (sum - 2.0 * square(radius_m)) /
                          std::sqrt(square(sum) - 4.0 * a2 * square(radius_m)));
    };
    std::vector<double> truths;
    for (const Vec3& x : positions) truths.push_back(illuminance(x));
    for (const Vec3& x : papers) truths.push_back(rho / pi * illuminance(x));
    for (std::size_t i = 0; i < truths.size(); ++i) {
        INFO(i);
        test::check_truth(result.quantities[i].estimate, truths[i]);
        test::check_refutes(result.quantities[i].estimate, 1.02 * truths[i]);
    }
}

TEST_CASE("Direct light: a rectangle that is partly behind the horizon", "[analytic]") {
    const double luminance = 2000.0;
    SceneBuilder scene;
    const Vec3 corner(-0.3, -0.5, 1.5);
    const Vec3 u(0.0, 1.0, 0.0);
    const Vec3 v(0.8, 0.0, 0.0);
    scene.area_light(scene.object("lamp", Rectangle{corner, u, v}, scene.black()), luminance);
    const Vec3 slanted = Vec3(1.0, 0.2, 0.5).normalized();
    const std::vector<Vec3> positions{{-1.5, 0.2, 0.8}, {0.2, 0.1, 1.1}};
    scene.points(positions, slanted);
    const Result result = test::run(scene, Method::combined, {96, 100});
    const auto polygon = truth::corners(corner, u, v);
    for (std::size_t i = 0; i < positions.size(); ++i) {
        const double truth = polygon_illuminance(polygon, luminance, positions[i], slanted);
        test::check_truth(result.quantities[i].estimate, truth);
        test::check_refutes(result.quantities[i].estimate, 1.02 * truth);
    }
}

TEST_CASE("Direct light: an asymmetric point luminaire, tilted and turned", "[analytic]") {
    const Vec3 position(0.1, 0.2, 2.0);
    const double rho = 0.5;
    SceneBuilder scene;
    const ObjectId shell =
        scene.object("shell", Sphere{position, 10.0}, scene.black());  // takes all light
    scene.receiver(shell);
    scene.object("paper", Disk{{1.0, 0.5, 0.0}, Vec3::UnitZ(), 0.1}, scene.diffuse(rho));
    scene.light("luminaire", luminaire(position), total_flux_lm());
    scene.points(floor_points, Vec3::UnitZ());
    scene.meter({0.5, 0.5, 1.0}, {1.0, 0.5, 0.0}, 0.005);
    const Result result = test::run(scene, Method::combined, {64, 1000});
    const auto illuminance = [&](const Vec3& x) {
        const Vec3 way = x - position;
        const Vec3 direction = way.normalized();
        return intensity_toward(direction) * -direction.z() / way.squaredNorm();
    };
    for (std::size_t i = 0; i < floor_points.size(); ++i) {
        const double truth = illuminance(floor_points[i]);
        test::check_truth(result.quantities[i].estimate, truth);
        test::check_refutes(result.quantities[i].estimate, 1.02 * truth);
    }
    test::check_truth(result.quantities[4].estimate, rho / pi * illuminance(floor_points[1]));
}

TEST_CASE("Direct light: a luminaire with an opening, from nearby", "[analytic]") {
    // Uniform over the opening: E = integral over it of I(w) / A cos / d^2.
    const Vec3 position(0.1, 0.2, 1.0);
    const truth::Axes& a = luminaire_axes;
    const double length_m = 0.6;
    const double width_m = 0.4;
    // The opening's normal points to gamma = 0.
    const Rectangle opening{position - 0.5 * length_m * a.c0 - 0.5 * width_m * a.c90,
                            width_m * a.c90, length_m * a.c0};
    const auto method = GENERATE(Method::combined, Method::path);
    SceneBuilder scene;
    const ObjectId object = scene.object("opening", opening, scene.black());
    Luminaire light = luminaire(position);
    light.object = object;
    light.opening = LuminousOpening(opening);
    scene.light("luminaire", light, total_flux_lm());
    scene.points(floor_points, Vec3::UnitZ());
    const Result result = test::run(scene, method, {96, 100});
    for (std::size_t i = 0; i < floor_points.size(); ++i) {
        constexpr int steps = 100;
        double truth = 0.0;
        for (int s = 0; s < steps; ++s) {
            for (int t = 0; t < steps; ++t) {
                const Vec3 from = opening.corner + (s + 0.5) / steps * opening.edge_u +
                                  (t + 0.5) / steps * opening.edge_v;
                const Vec3 way = floor_points[i] - from;
                const Vec3 direction = way.normalized();
                truth += intensity_toward(direction) * -direction.z() / way.squaredNorm();
            }
        }
        truth /= steps * steps;
        test::check_truth(result.quantities[i].estimate, truth);
        test::check_refutes(result.quantities[i].estimate, 1.02 * truth);
    }
}

TEST_CASE("Direct light: absorption on a straight way", "[analytic]") {
    // A slab of index 1 bends nothing: E = E_0 exp(-alpha l). With a boundary that does not act,
    // shadow rays cross it; with a refracting boundary of equal indices, photons do.
    const bool acts = GENERATE(false, true);
    const double absorption_per_m = 2.0;
    const double thickness_m = 0.2;
    const double intensity = 100.0;
    const double beam_rad = 30.0 * rad_per_deg;
    const double rho = 0.5;
    SceneBuilder scene;
    Placement below = Placement::Identity();
    below.translate(Vec3(-2.0, -2.0, 0.4));
    const ObjectId slab = scene.solid("slab", Box{below, {4.0, 4.0, thickness_m}},
                                      scene.medium(1.0, absorption_per_m));
    if (!acts) scene.parts.objects[slab].front = scene.parts.objects[slab].back = pass_through;
    scene.object("floor", Rectangle{{-2, -2, 0}, {4, 0, 0}, {0, 4, 0}}, scene.diffuse(rho));
    // A lamp of uniform intensity within its beam, at (0, 0, 1).
    Luminaire lamp;
    lamp.position = Vec3::UnitZ();
    lamp.to_photometric.setIdentity();
    lamp.intensity = std::make_shared<const IntensityDistribution>(
        std::vector{0.0}, std::vector{0.0, beam_rad / rad_per_deg},
        std::vector<std::vector<double>>{{intensity, intensity}});
    scene.light("lamp", lamp, intensity * 2.0 * pi * (1.0 - std::cos(beam_rad)));
    // The camera sees a square within the beam from below the slab.
    const double half_width_m = 0.3;
    scene.camera({0.0, 0.0, 0.35}, Vec3::Zero(), Vec3::UnitY(),
                 2.0 * std::atan(half_width_m / 0.35), 24, 24);
    const auto mean = [&](double absorption) {
        const auto luminance = [&](double x, double y) {
            const double distance_m = std::sqrt(x * x + y * y + 1.0);
            return rho / pi * intensity / std::pow(distance_m, 3) *
                   std::exp(-absorption * thickness_m * distance_m);
        };
        const double integral = truth::integral(
            [&](double x) {
                return truth::integral([&](double y) { return luminance(x, y); }, -half_width_m,
                                       half_width_m, 1);
            },
            -half_width_m, half_width_m, 1);
        return integral / (4.0 * half_width_m * half_width_m);
    };
    const test::Effort effort = acts ? test::Effort{20, 5000} : test::Effort{20, 100};
    const test::Replicates runs(scene, Method::combined, effort, 16, [](const Result& result) {
        return std::vector{test::mean_of_image(result.images.front())};
    });
    test::check_truth_over_runs(runs[0], mean(absorption_per_m));
    test::check_refutes_over_runs(runs[0], mean(1.05 * absorption_per_m));
}
