// Slabs of glass, clear, absorbing and dispersive, and what a meter reads inside glass.
//
// Light that has met a boundary obliquely is partly polarised, and meets the next one otherwise
// than unpolarised light would. The truths follow s and p apart; what averaging over polarisation
// at each boundary would give is the twin that is refuted.
#include "optics/transport/path.h"
#include "spectral/observer.h"
#include "tests/support/truth_checks.h"
#include "validation/truth/luminance_weights.h"
#include "validation/truth/quadrature.h"
#include "validation/truth/sky_light.h"
#include "validation/truth/slab.h"

using namespace lucerna;
using namespace lucerna::optics;
using truth::polarised_transmittance;
using truth::unpolarised_transmittance;
using validation::SceneBuilder;

namespace {

constexpr double luminance = 1000.0;
constexpr double thickness_m = 0.1;
constexpr double n = 1.5;

double radians(double degrees) {
    return degrees * pi / 180.0;
}

// A slab of 6 m x 6 m from z = 0.1 on above an emitter of uniform luminance at z = 0.
SceneBuilder slab_over_emitter(SceneBuilder scene, MediumId medium) {
    scene.area_light(
        scene.object("emitter", Rectangle{{-5, -5, 0}, {10, 0, 0}, {0, 10, 0}}, scene.black()),
        luminance);
    Placement place = Placement::Identity();
    place.translate(Vec3(-3.0, -3.0, 0.1));
    scene.solid("slab", Box{place, {6.0, 6.0, thickness_m}}, medium);
    return scene;
}

// A meter above the slab that sees its middle under an angle.
void meter_at(SceneBuilder& scene, double angle_rad) {
    const Vec3 target(0.0, 0.0, 0.1 + thickness_m);
    scene.meter(target + Vec3(std::sin(angle_rad), 0.0, std::cos(angle_rad)), target, 0.004);
}

}  // namespace

TEST_CASE("Slab: luminance through clear and absorbing glass", "[analytic]") {
    const double absorption_per_m = GENERATE(0.0, 4.0);
    SceneBuilder materials;
    const MediumId glass = materials.medium(n, absorption_per_m);
    SceneBuilder scene = slab_over_emitter(std::move(materials), glass);
    const std::vector<double> angles_deg{0.0, 45.0, 60.0, 75.0};
    for (const double angle : angles_deg) meter_at(scene, radians(angle));
    const Result result = test::run(scene, Method::combined, {24, 100});
    const double depth = absorption_per_m * thickness_m;
    for (std::size_t i = 0; i < angles_deg.size(); ++i) {
        const double angle_rad = radians(angles_deg[i]);
        INFO("absorption " << depth << " angle " << angles_deg[i]);
        const Estimate& estimate = result.quantities[i].estimate;
        test::check_truth(estimate, luminance * polarised_transmittance(n, angle_rad, depth));
        const double reflectance = truth::boundary(n, angle_rad).mean();
        // One boundary only; one boundary too many; the n^2 of the inside.
        const double single = luminance * (1.0 - reflectance) * truth::passage(n, angle_rad, depth);
        test::check_refutes(estimate, single);
        test::check_refutes(estimate, single / (n * n));
        if (angles_deg[i] == 75.0) {
            // No internal reflections.
            test::check_refutes(estimate, single * (1.0 - reflectance));
        }
        if (angles_deg[i] >= 60.0) {
            test::check_refutes(estimate,
                                luminance * unpolarised_transmittance(n, angle_rad, depth));
        }
    }
    // Asked to count light as unpolarised at each event, the engine does so.
    test::Effort effort{24, 100};
    effort.polarisation = false;
    const Result unpolarised = test::run(scene, Method::combined, effort);
    for (std::size_t i = 0; i < angles_deg.size(); ++i) {
        test::check_truth(unpolarised.quantities[i].estimate,
                          luminance * unpolarised_transmittance(n, radians(angles_deg[i]), depth));
    }
}

TEST_CASE("Slab: a meter inside glass reads n^2 (1 - R) L", "[analytic]") {
    SceneBuilder materials;
    const MediumId glass = materials.medium(n);
    SceneBuilder scene = slab_over_emitter(std::move(materials), glass);
    const Vec3 inside(0.0, 0.0, 0.1 + 0.5 * thickness_m);
    const std::vector<double> angles_rad{0.0, std::asin(std::sin(radians(60.0)) / n)};
    for (const double angle : angles_rad) {
        scene.meter(inside, inside + Vec3(std::sin(angle), 0.0, -std::cos(angle)), 0.004);
    }
    const Result result = test::run(scene, Method::combined, {64, 100});
    for (std::size_t i = 0; i < angles_rad.size(); ++i) {
        const double outside_rad = std::asin(std::min(1.0, n * std::sin(angles_rad[i])));
        const truth::Boundary r = truth::boundary(n, outside_rad);
        const double reflectance = r.mean();
        // Light that the upper boundary sends back adds R^2, R^4 ...: (1 - R) / (1 - R^2), for s
        // and p apart.
        const double truth = n * n * luminance * 0.5 * (1.0 / (1.0 + r.s) + 1.0 / (1.0 + r.p));
        test::check_truth(result.quantities[i].estimate, truth);
        test::check_refutes(result.quantities[i].estimate, truth / (n * n));
        test::check_refutes(result.quantities[i].estimate, truth * (1.0 + reflectance));
    }
}

TEST_CASE("Slab: flux of a Lambertian source", "[analytic]") {
    const double absorption_per_m = GENERATE(0.0, 40.0);
    constexpr double thin_m = 0.01;
    SceneBuilder scene;
    const ObjectId lamp =
        scene.object("lamp", Disk{Vec3::Zero(), Vec3::UnitZ(), 0.05}, scene.black());
    scene.light("lamp", AreaLight{lamp, scene.parts.objects[lamp].shape}, 1000.0);
    Placement place = Placement::Identity();
    place.translate(Vec3(-3.0, -3.0, 0.001));
    scene.solid("slab", Box{place, {6.0, 6.0, thin_m}}, scene.medium(n, absorption_per_m));
    scene.receiver(
        scene.object("sheet", Rectangle{{-3, -3, 0.012}, {0, 6, 0}, {6, 0, 0}}, scene.black()));
    const Result result = test::run(scene, Method::combined, {64, 8000});
    // The normal of the sheet points down, toward the lamp. What passes beside it is the light
    // within 4 mrad of the horizon: 2e-5.
    const auto mean_transmittance = [&](auto&& transmittance) {
        return truth::integral(
            [&](double angle_rad) { return transmittance(angle_rad) * std::sin(2.0 * angle_rad); },
            0.0, 0.5 * pi);
    };
    const double truth = mean_transmittance([&](double angle_rad) {
        return polarised_transmittance(n, angle_rad, absorption_per_m * thin_m);
    });
    test::check_truth(result.quantities[0].estimate, 1000.0 * truth);
    test::check_refutes(result.quantities[0].estimate,
                        1000.0 * unpolarised_transmittance(n, 0.0, absorption_per_m * thin_m));
}

TEST_CASE("Slab: luminance and colour through dispersive glass", "[analytic]") {
    // Cauchy's formula for a glass like N-BK7, and an invented glass that falls from 2.0 to 1.4.
    const bool steep = GENERATE(false, true);
    const auto index_at = [&](double nm) {
        return steep ? 2.0 - 0.6 * (nm - 360.0) / 470.0 : 1.5046 + 4200.0 / (nm * nm);
    };
    const std::vector<double> angles_rad{0.0, radians(60.0)};
    const auto scene_with = [&](const std::function<double(double)>& index) {
        SceneBuilder materials;
        const MediumId glass = materials.dispersive_medium(index);
        SceneBuilder scene = slab_over_emitter(std::move(materials), glass);
        for (const double angle : angles_rad) {
            const Vec3 target(0.0, 0.0, 0.1 + thickness_m);
            scene.camera(target + Vec3(std::sin(angle), 0.0, std::cos(angle)), target,
                         Vec3::UnitY(), 0.01, 4, 4);
        }
        return scene;
    };
    const auto tristimulus = [](const Image& image) {
        Vec3 xyz(0.0, image.mean.mean(), 0.0);
        for (std::size_t i = 0; i < image.x.size(); ++i) {
            xyz.x() += static_cast<double>(image.x[i]) / static_cast<double>(image.x.size());
            xyz.z() += static_cast<double>(image.z[i]) / static_cast<double>(image.x.size());
        }
        return xyz;
    };
    // The same wavelengths through a slab of index 1, which takes nothing, say what part of the
    // spread is theirs.
    const SceneBuilder empty = scene_with([](double) { return 1.0; });
    const test::Effort effort{256, 50, 4};
    const test::Replicates runs(
        scene_with(index_at), Method::combined, effort, 16, [&](const Result& result) {
            const Result without =
                test::run(empty, Method::combined, effort, result.settings.seed, 1);
            std::vector<test::Replicates::Value> values;
            for (std::size_t i = 0; i < result.images.size(); ++i) {
                const Vec3 passed =
                    (tristimulus(result.images[i]).array() / tristimulus(without.images[i]).array())
                        .matrix();
                values.push_back({luminance * passed.y()});
                values.push_back({passed.x() / passed.y()});
                values.push_back({passed.z() / passed.y()});
            }
            return values;
        });
    for (std::size_t i = 0; i < angles_rad.size(); ++i) {
        const auto transmittance = [&](double nm) {
            return polarised_transmittance(index_at(nm), angles_rad[i]);
        };
        const double y = truth::luminous_mean(transmittance);
        const double x = truth::weighted_mean(spectral::x_bar(), transmittance);
        const double z = truth::weighted_mean(spectral::z_bar(), transmittance);
        INFO("steep " << steep << " angle " << angles_rad[i]);
        test::check_truth_over_runs(runs[3 * i], luminance * y);
        // X, Y and Z of an equal-energy spectrum are alike.
        test::check_truth_over_runs(runs[3 * i + 1], x / y);
        test::check_truth_over_runs(runs[3 * i + 2], z / y);
        test::check_refutes_over_runs(runs[3 * i], luminance);
        if (steep) test::check_refutes_over_runs(runs[3 * i + 2], 1.0);
    }
}

namespace {

constexpr double rho = 0.6;
const Vec3 centre(0.5, 0.5, 0.5);

enum class Ball { clear, dispersive };

double ball_index_at(Ball ball, double nm) {
    return ball == Ball::dispersive ? 2.0 - 0.6 * (nm - 360.0) / 470.0 : n;
}

// A lossless ball emits nothing and takes nothing. By the invariance of L / n^2 along a ray nothing
// changes outside, and in the middle of the ball L = n^2 L_e / (1 - rho) in all directions.
SceneBuilder ball_in_furnace(Ball ball) {
    SceneBuilder scene;
    for (const Shape& wall : SceneBuilder::room(1.0, 1.0, 1.0)) {
        scene.area_light(scene.object("wall", wall, scene.diffuse(rho)), luminance);
    }
    const MediumId glass =
        ball == Ball::clear
            ? scene.medium(n)
            : scene.dispersive_medium([&](double nm) { return ball_index_at(ball, nm); });
    scene.solid("ball", Sphere{centre, 0.3}, glass);
    return scene;
}

double mean_squared_index(Ball ball) {
    return truth::luminous_mean([&](double nm) { return std::pow(ball_index_at(ball, nm), 2); });
}

// Values over batches of phases.
template <typename Place, typename Read>
std::vector<Estimate> ball_runs(Ball ball, Method method, const test::Effort& effort,
                                const Place& place_observers, const Read& read) {
    SceneBuilder scene = ball_in_furnace(ball);
    place_observers(scene);
    return test::over_batches(scene, method, effort, 16, read);
}

}  // namespace

TEST_CASE("Glass in a furnace: luminance in air and in glass", "[analytic]") {
    const auto [ball, method, phases] =
        GENERATE(table<Ball, Method, std::uint32_t>({{Ball::clear, Method::combined, 20},
                                                     {Ball::dispersive, Method::combined, 50},
                                                     {Ball::dispersive, Method::forward, 80},
                                                     {Ball::dispersive, Method::backward, 60}}));
    const double truth = luminance / (1.0 - rho);
    const auto runs = ball_runs(
        ball, method, {phases, 2000, 4},
        [](SceneBuilder& scene) {
            scene.camera({0.05, 0.05, 0.1}, centre, Vec3::UnitZ(), 0.5, 8, 8);           // the ball
            scene.camera({0.05, 0.1, 0.1}, {0.05, 1.0, 0.1}, Vec3::UnitZ(), 0.5, 8, 8);  // walls
            scene.camera(centre, {0.9, 0.2, 0.3}, Vec3::UnitZ(), 0.5, 8, 8);  // from within
        },
        [](const Result& result) {
            std::vector<test::Replicates::Value> values;
            for (const Image& image : result.images) values.push_back(test::mean_of_image(image));
            return values;
        });
    const double squared = mean_squared_index(ball);
    INFO("ball " << static_cast<int>(ball) << " method " << static_cast<int>(method));
    const double demand = 0.005;
    test::check_truth_over_runs(runs[0], truth, demand);
    test::check_truth_over_runs(runs[1], truth, demand);
    test::check_truth_over_runs(runs[2], squared * truth, demand);
    test::check_refutes_over_runs(runs[0], truth / (n * n));
    test::check_refutes_over_runs(runs[1], 1.05 * truth);
    test::check_refutes_over_runs(runs[2], truth);
}

TEST_CASE("Glass in a furnace: light that parts by wavelength before and behind the wall seen",
          "[analytic]") {
    // One forward ray in 16 has the lane of a backward ray that it meets.
    SceneBuilder scene = ball_in_furnace(Ball::dispersive);
    scene.camera({0.05, 0.05, 0.1}, centre, Vec3::UnitZ(), 0.5, 8, 8);
    const Result result = test::run(scene, Method::combined, {96, 2000, 4});
    const Estimate& mean = result.images[0].mean;
    test::check_mean(mean.value(), mean.standard_error(), luminance / (1.0 - rho), {0.35});
}

TEST_CASE("Every lane is as likely to go on alone", "[property]") {
    SceneBuilder scene = ball_in_furnace(Ball::dispersive);
    scene.points({centre}, Vec3::UnitZ());
    const Stage stage(scene.parts);
    constexpr int steps = 160, phases = 400;
    Lanes alone = Lanes::Zero(), common = Lanes::Zero();
    for (int i = 0; i < steps; ++i) ++alone[choose_hero((i + 0.5) / steps)];
    CHECK((alone == static_cast<float>(steps / spectral::lane_count)).all());
    for (std::uint32_t number = 0; number < phases; ++number) {
        const Phase phase(stage, 1, number);
        for (int i = 0; i < steps; ++i) ++common[choose_common_hero(phase, (i + 0.5) / steps)];
    }
    // A lane belongs to half of the phases, within five standard deviations of 400 throws.
    common /= static_cast<float>(steps / spectral::lane_count * phases);
    CHECK((common - 1.0f).abs().maxCoeff() < 5.0f / std::sqrt(static_cast<float>(phases)));
}

TEST_CASE("Glass on both sides of a wall: rays that go straight through it, each on its lane",
          "[analytic]") {
    // A point lamp and a pinhole in the middles of two balls of dispersive glass: no ray is bent,
    // all part by wavelength. What a boundary reflects comes back through the middle and leaves on
    // the other side, so that the lamp loses nothing, and the eye sees the wall with 1 / (1 + R) by
    // 1 - R + (1 - R) R^2 + ..., the rest being darkness behind it.
    const auto index = [](double nm) { return ball_index_at(Ball::dispersive, nm); };
    const Vec3 lamp(-0.5, 0.0, 2.0), eye(0.5, 0.0, 2.0);
    constexpr double flux_lm = 1000.0, reflectance = 0.5;
    SceneBuilder scene;
    scene.object("wall", Rectangle{{-2, -2, 0}, {4, 0, 0}, {0, 4, 0}}, scene.diffuse(reflectance));
    const MediumId glass = scene.dispersive_medium(index);
    scene.solid("around the lamp", Sphere{lamp, 0.05}, glass);
    scene.solid("around the eye", Sphere{eye, 0.05}, glass);
    scene.light("lamp", PointLight{lamp}, flux_lm);
    scene.camera(eye, Vec3::Zero(), Vec3::UnitY(), 0.03, 8, 8);
    const double distance_m = lamp.norm();
    const double illuminance =
        flux_lm / (4.0 * pi * distance_m * distance_m) * lamp.z() / distance_m;
    const double seen = truth::luminous_mean([&](double nm) {
        const double r = std::pow((index(nm) - 1.0) / (index(nm) + 1.0), 2);
        return std::pow(index(nm), 2) / (1.0 + r);
    });
    const double truth = reflectance * illuminance / pi * seen;
    const auto runs = test::over_batches(
        scene, Method::combined, {6, 20000, 8}, 16,
        [](const Result& result) { return std::vector{test::mean_of_image(result.images[0])}; });
    test::check_truth_over_runs(runs[0], truth, 0.01);
    test::check_refutes_over_runs(runs[0], 1.15 * truth);
}

TEST_CASE("Glass in a furnace: illuminance in glass", "[analytic]") {
    const auto [ball, method, phases] = GENERATE(table<Ball, Method, std::uint32_t>(
        {{Ball::clear, Method::forward, 4}, {Ball::dispersive, Method::combined, 3}}));
    std::vector<Vec3> positions;
    for (int i = -2; i <= 2; ++i) {
        for (int j = -2; j <= 2; ++j) positions.push_back(centre + 0.04 * Vec3(i, j, 0.0));
    }
    const double air = pi * luminance / (1.0 - rho);
    const auto runs = ball_runs(
        ball, method, {phases, 5000},
        [&](SceneBuilder& scene) { scene.points(positions, Vec3::UnitZ()); },
        [](const Result& result) { return std::vector{test::mean_of_sensors(result)}; });
    const double truth = mean_squared_index(ball) * air;
    INFO("ball " << static_cast<int>(ball) << " method " << static_cast<int>(method));
    test::check_truth_over_runs(runs[0], truth, 0.01);
    test::check_refutes_over_runs(runs[0], 0.9 * truth);
}

TEST_CASE("A pane before a lamp: illuminance, and luminance of paper", "[analytic]") {
    // The lamp is wider than a square hole in a black sheet below the pane, so that what is seen
    // through the hole is the luminance of the lamp and the transmittance of the pane.
    constexpr double rho = 0.5, absorption_per_m = 5.0, pane_m = 0.02, half_m = 0.4, hole_z_m = 2.0;
    SceneBuilder scene;
    scene.area_light(
        scene.object("lamp", Rectangle{{-2, -2, 2.2}, {0, 4, 0}, {4, 0, 0}}, scene.black()),
        luminance);
    Placement place = Placement::Identity();
    place.translate(Vec3(-1.5, -1.5, 2.05));
    scene.solid("pane", Box{place, {3.0, 3.0, pane_m}}, scene.medium(n, absorption_per_m));
    const BsdfId black = scene.black();
    const double rest_m = 3.0 - half_m;
    for (const double side : {-1.0, 1.0}) {
        const double first_m = side < 0.0 ? -3.0 : half_m;
        scene.object("sheet", Rectangle{{first_m, -3.0, hole_z_m}, {rest_m, 0, 0}, {0, 6, 0}},
                     black);
        scene.object("sheet",
                     Rectangle{{-half_m, first_m, hole_z_m}, {2.0 * half_m, 0, 0}, {0, rest_m, 0}},
                     black);
    }
    scene.object("floor", Rectangle{{-3, -3, 0}, {6, 0, 0}, {0, 6, 0}}, black);
    // What it sends back to the pane and receives again is 1e-4 of what it has.
    const Vec3 paper(0.5, -0.3, 1e-3);
    scene.object("paper", Rectangle{paper - Vec3(0.4, 0.4, 0.0), {0.8, 0, 0}, {0, 0.8, 0}},
                 scene.diffuse(rho));
    const std::vector<Vec3> points{{0, 0, 0}, {0.8, 0.4, 0}};
    scene.points(points, Vec3::UnitZ());
    scene.meter({0.8, -0.3, 0.5}, paper, 0.01);
    // A camera wants the map of caustics, which the sensors then have to leave alone.
    scene.camera({1, 1, 1}, paper, Vec3::UnitZ(), 0.1, 4, 4);
    const auto illuminance = [&](const Vec3& x, bool polarised) {
        return truth::illuminance_through(
            [&](const Vec3& w) {
                const double incidence_rad = std::acos(std::min(1.0, w.z()));
                return luminance * (polarised ? polarised_transmittance(n, incidence_rad,
                                                                        absorption_per_m * pane_m)
                                              : 1.0);
            },
            {-half_m, -half_m, hole_z_m}, {2.0 * half_m, 0, 0}, {0, 2.0 * half_m, 0}, {}, x,
            Vec3::UnitZ(), 8);
    };
    const Result result = test::run(scene, Method::combined, {400, 3000});
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3& x = i < 2 ? points[i] : paper;
        const double factor = i < 2 ? 1.0 : rho / pi;
        INFO("reading " << i);
        test::check_truth(result.quantities[i].estimate, factor * illuminance(x, true));
        test::check_refutes(result.quantities[i].estimate, factor * illuminance(x, false));
        // Found by rays: a kernel beside the shadow of the sheet would be biased by a tenth.
        CHECK(std::abs(result.quantities[i].estimate.bias()) <
              1e-3 * factor * illuminance(x, true));
    }
}
