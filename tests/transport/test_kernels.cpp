// Kernels of the photon maps where the surface ends.
#include <catch2/catch.hpp>

#include "optics/transport/forward_map.h"
#include "optics/transport/path.h"
#include "validation/scene_builder.h"
#include "validation/truth/quadrature.h"

using namespace lucerna;
using namespace lucerna::optics;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

TEST_CASE("Kernels end where the surface ends, at both radii", "[unit]") {
    validation::SceneBuilder scene;
    const ObjectId plate =
        scene.object("plate", Rectangle{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, scene.diffuse(0.5));
    scene.light("light", PointLight{{0, 0, 1}}, 1.0);
    scene.receiver(plate);
    const Stage stage(scene.parts);
    const double radius_m = 0.1;
    const double disc = pi * radius_m * radius_m;
    const auto areas_at = [&](double x, double y) {
        return kernel_areas(stage, {{x, y, 0}, Vec3::UnitZ(), plate}, radius_m);
    };
    const KernelAreas inside = areas_at(0.5, 0.4);
    CHECK_THAT(inside.full, WithinRel(disc, 1e-12));
    CHECK_THAT(inside.inner, WithinRel(disc / 2.0, 1e-12));
    const KernelAreas edge = areas_at(0.5, 0.0);
    CHECK_THAT(edge.full, WithinRel(disc / 2.0, 1e-12));
    CHECK_THAT(edge.inner, WithinRel(disc / 4.0, 1e-12));
    const KernelAreas corner = areas_at(1.0, 1.0);
    CHECK_THAT(corner.full, WithinRel(disc / 4.0, 1e-12));
    CHECK_THAT(corner.inner, WithinRel(disc / 8.0, 1e-12));
    // The outer circle crosses the edge, the inner one does not: less the segment
    // r^2 (a - sin a cos a), cos a = 0.8.
    const KernelAreas near_edge = areas_at(0.5, 0.8 * radius_m);
    const double a = std::acos(0.8);
    CHECK_THAT(near_edge.full, WithinRel(disc - radius_m * radius_m * (a - 0.6 * 0.8), 1e-12));
    CHECK_THAT(near_edge.inner, WithinRel(disc / 2.0, 1e-12));
}

namespace {

constexpr double kernel_radius_m = 0.1;

// What a kernel in the middle of a white plate gathers of photons on a fine grid:
// E(x, y) with x and y in radii from the centre of the kernel.
template <typename Field>
Gathered gathered_of(const Field& field, bool tells_steps = true, double transmittance = 0.0) {
    validation::SceneBuilder scene;
    const BsdfId paint = scene.diffuse(1.0 - transmittance, transmittance);
    const ObjectId plate = scene.object("plate", Rectangle{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, paint);
    scene.light("light", PointLight{{0, 0, 1}}, 1.0);
    scene.receiver(plate);
    const Stage stage(scene.parts);
    const Phase phase(stage, 1, 0);
    const Vec3 centre(0.5, 0.4, 0.0);
    const double step_m = kernel_radius_m / 200.0, rays = 7.0;
    std::vector<Photon> photons;
    for (int i = -220; i < 220; ++i) {
        for (int j = -220; j < 220; ++j) {
            const Vec3 offset((i + 0.5) * step_m, (j + 0.5) * step_m, 0.0);
            const double flux = field(offset.x() / kernel_radius_m, offset.y() / kernel_radius_m) *
                                step_m * step_m * rays;
            photons.push_back({{centre + offset, Vec3::UnitZ(), plate},
                               -Vec3::UnitZ(),
                               Lanes::Constant(static_cast<float>(flux)),
                               History::caustic});
            // From below: irradiance 10 on all of it.
            photons.push_back({{centre + offset, Vec3::UnitZ(), plate},
                               Vec3::UnitZ(),
                               Lanes::Constant(static_cast<float>(10.0 * step_m * step_m * rays)),
                               History::caustic});
        }
    }
    const Radii radii({kernel_radius_m});
    const ForwardMap map(stage, radii, {&photons, 1}, static_cast<std::uint64_t>(rays), 1);
    const SurfacePoint point{centre, Vec3::UnitZ(), plate};
    const Frame frame(point.normal);
    const Vec3 wo = Vec3::UnitZ();
    const SurfaceOptics optics = optics_at(phase, no_object, no_object, false, 0);
    return map.gather(phase, radii,
                      {.point = point,
                       .frame = frame,
                       .wo = wo,
                       .bsdf = stage.parts().bsdfs[paint],
                       .optics = optics,
                       .tells_steps = tells_steps});
}

// As irradiance.
double of_white(const Lanes& radiance) {
    return pi * static_cast<double>(radiance[0]);
}

template <typename Field>
std::pair<double, double> irradiance_and_bias(const Field& field) {
    const Gathered gathered = gathered_of(field);
    return {of_white(gathered.radiance), of_white(gathered.bias)};
}

}  // namespace

// Cells on the rims of the kernels: about 2e-4 of each sum.
TEST_CASE("What two kernels tell of the kernel bias makes a curved field exact", "[analytic]") {
    // The mean of 1 - k d^2 over a disc of radius 1 around 0 is 1 - k / 2.
    const auto [irradiance, bias] =
        irradiance_and_bias([](double x, double y) { return 1.0 - 0.2 * (x * x + y * y); });
    CHECK_THAT(irradiance, WithinRel(0.9, 1e-3));
    CHECK_THAT(bias, WithinRel(-0.1, 0.01));
}

TEST_CASE("Whole discs gather alike where places are told in single precision", "[unit]") {
    const auto field = [](double x, double y) { return 3.0 + x + 2.0 * x * y - y * y; };
    const Gathered exact = gathered_of(field, true), quick = gathered_of(field, false);
    // What is rounded over a rim is some 1e-7 m of 0.1 m.
    CHECK_THAT(of_white(quick.radiance), WithinRel(of_white(exact.radiance), 1e-4));
    CHECK_THAT(of_white(quick.bias), WithinAbs(of_white(exact.bias), 1e-4));
    CHECK(quick.photons > 100000);
    // Nothing of the light from below counts, unless the plate lets it through.
    CHECK(2 * quick.photons < exact.photons + 100);
    const Gathered through = gathered_of(field, false, 0.25);
    CHECK_THAT(of_white(through.radiance),
               WithinRel(0.75 * of_white(quick.radiance) + 0.25 * 10.0, 1e-3));
    // The cells on the rim are some 2e-4 of a sum of 5; a bias is the difference of two.
    CHECK_THAT(of_white(through.bias), WithinAbs(0.75 * of_white(quick.bias), 2.4e-3));
}

TEST_CASE("Kernels at edges, barriers and of heroes gather alike by places in single precision",
          "[unit]") {
    validation::SceneBuilder scene;
    const BsdfId paint = scene.diffuse(0.5);
    const ObjectId plate = scene.object("plate", Rectangle{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, paint);
    scene.object("wall", Rectangle{{0.5, 0, 0}, {0, 1, 0}, {0, 0, 1}}, paint);
    scene.light("light", PointLight{{0, 0, 1}}, 1.0);
    scene.receiver(plate);
    const Stage stage(scene.parts);
    const Phase phase(stage, 1, 0);
    std::vector<Photon> photons;
    RandomStream random(1, 0, RandomPurpose::test, 0);
    for (int i = 0; i < 200000; ++i) {
        const double x = random.uniform();
        const Vec3 position(x, random.uniform(), 0.0);
        photons.push_back({{position, Vec3::UnitZ(), plate},
                           -Vec3::UnitZ(),
                           Lanes::Constant(static_cast<float>(random.uniform())),
                           History::caustic,
                           i % 3 == 0});
    }
    const Radii radii(std::vector<double>(stage.patch_count(), kernel_radius_m));
    const ForwardMap map(stage, radii, {&photons, 1}, 1000, 1);
    // No light is left out, but then each photon is looked at by itself.
    const std::vector<bool> none(1, false);
    const auto gathered = [&](const Vec3& position, bool hero_only, const std::vector<bool>* but) {
        const SurfacePoint point{position, Vec3::UnitZ(), plate};
        const auto region = KernelRegion::within(stage, point, Vec3::UnitZ(), kernel_radius_m);
        const Frame frame(point.normal);
        const Vec3 wo = Vec3::UnitZ();
        const SurfaceOptics optics = optics_at(phase, no_object, no_object, hero_only, 0);
        GatherPoint at{point, frame, wo, stage.parts().bsdfs[paint], optics};
        at.region = region ? &*region : nullptr;
        at.but_of = but;
        return map.gather(phase, radii, at);
    };
    for (const bool hero_only : {false, true}) {
        for (const Vec3& position :
             {Vec3(0.03, 0.2, 0.0), Vec3(0.45, 0.4, 0.0), Vec3(0.52, 0.97, 0.0)}) {
            INFO(position.transpose() << (hero_only ? ", hero" : ""));
            const Gathered quick = gathered(position, hero_only, nullptr);
            const Gathered exact = gathered(position, hero_only, &none);
            CHECK(quick.photons == exact.photons);
            // Sums in another order.
            CHECK_THAT(of_white(quick.radiance), WithinRel(of_white(exact.radiance), 1e-5));
            CHECK_THAT(of_white(quick.bias),
                       WithinAbs(of_white(exact.bias), 1e-5 * of_white(exact.radiance)));
            CHECK(quick.photons > 500);
        }
    }
}

TEST_CASE("Cells around a point hold all points of its ball, or of a plane through it", "[unit]") {
    constexpr double cell_m = 0.3;
    RandomStream random(2, 0, RandomPurpose::test, 0);
    const auto in_cube = [&](double half_m) -> Vec3 {
        const double x = random.uniform(), y = random.uniform();
        return half_m * (2.0 * Vec3(x, y, random.uniform()) - Vec3::Ones());
    };
    const PatchCells cells(3, cell_m);
    std::size_t of_balls = 0, of_planes = 0;
    for (int i = 0; i < 300; ++i) {
        const Vec3 centre = in_cube(5.0), normal = in_cube(1.0).normalized();
        const double radius_m = cell_m * random.uniform();
        std::vector<std::uint64_t> around, along_plane;
        cells.for_each_around(centre, radius_m, nullptr, 0.0,
                              [&](std::uint64_t hash) { around.push_back(hash); });
        cells.for_each_around(centre, radius_m, &normal, 0.0,
                              [&](std::uint64_t hash) { along_plane.push_back(hash); });
        of_balls += around.size();
        of_planes += along_plane.size();
        for (int k = 0; k < 200; ++k) {
            const Vec3 offset = in_cube(radius_m);
            if (offset.norm() >= radius_m) continue;
            const Vec3 in_plane = offset - offset.dot(normal) * normal;
            CHECK(std::ranges::count(around, cells.hash_at(centre + offset)) == 1);
            CHECK(std::ranges::count(along_plane, cells.hash_at(centre + in_plane)) == 1);
        }
    }
    CHECK(of_planes < of_balls);  // the twin: some are left out
}

TEST_CASE("What photons make a kernel's bias vary by", "[analytic]") {
    // Photons at even steps of s = d^2 / r^2 fill a disc evenly.
    constexpr int steps = 10000;
    double mean = 0.0, square_mean = 0.0;
    for (int i = 0; i < steps; ++i) {
        const double of_bias = 1.0 - narrow_weight((i + 0.5) / steps);
        mean += of_bias / steps;
        square_mean += of_bias * of_bias / steps;
    }
    CHECK_THAT(mean, WithinAbs(0.0, 1e-6));
    CHECK_THAT(variance_of_bias, WithinRel(square_mean, 1e-6));
}

TEST_CASE("What two kernels tell of the kernel bias leaves a tenth of the fourth order",
          "[analytic]") {
    // The mean of d^4 over the disc is 1/3; weighed by 6 (1 - 2 d^2) (1 - d^2) it is -1/10.
    const auto [irradiance, bias] =
        irradiance_and_bias([](double x, double y) { return 1.0 + square(x * x + y * y); });
    CHECK_THAT(irradiance, WithinRel(4.0 / 3.0, 1e-3));
    CHECK_THAT(irradiance - bias, WithinRel(0.9, 1e-3));
}

TEST_CASE("What two kernels tell of the kernel bias bounds what an edge leaves of it",
          "[analytic]") {
    // Light ends at a straight line. Past it lies a segment of the disc, and of the narrow kernel
    // what its chords hold: for |y| < h, and with s = x^2 + y^2.
    for (const double edge : {0.3, 0.5, 0.7, 0.9}) {
        const auto [irradiance, bias] =
            irradiance_and_bias([&](double x, double) { return x < edge ? 1.0 : 0.0; });
        const double lost =
            truth::integral(
                [](double x) {
                    const double h = std::sqrt(1.0 - x * x);
                    const double a = 1.0 - x * x, b = 1.0 - 2.0 * x * x;
                    // of (b - 2 y^2) (a - y^2)
                    return 2.0 * h *
                           (a * b - (2.0 * a + b) * h * h / 3.0 + 2.0 * h * h * h * h / 5.0);
                },
                edge, 1.0, 16) *
            6.0 / pi;
        CAPTURE(edge);
        CHECK_THAT(
            irradiance,
            WithinAbs(1.0 - (std::acos(edge) - edge * std::sqrt(1.0 - edge * edge)) / pi, 0.002));
        CHECK_THAT(irradiance - bias, WithinAbs(1.0 - lost, 0.004));
        CHECK(std::abs(irradiance - bias - 1.0) < 0.5 * std::abs(bias));
    }
}

TEST_CASE("What a kernel tells of steps is their error, and nothing of a slope", "[analytic]") {
    // A step of height h through the middle leaves h / 2 on both sides, and points to the light.
    for (const double sign : {1.0, -1.0}) {
        const Gathered step =
            gathered_of([&](double x, double) { return sign * x > 0.0 ? 3.0 : 1.0; });
        CHECK_THAT(of_white(step.step[0]), WithinAbs(sign, 0.01));
        CHECK_THAT(of_white(step.slope[0]), WithinAbs(sign * 4.0 / (3.0 * pi), 0.002));
        CHECK(std::abs(of_white(step.step[1])) < 1e-4);
        CHECK(std::abs(of_white(step.bias)) < 0.01);
    }
    // The mean of g x^2 over the disc is g / 4.
    const Gathered slope = gathered_of([](double, double y) { return 2.0 + 0.8 * y; });
    CHECK_THAT(of_white(slope.slope[1]), WithinAbs(0.2, 1e-3));
    for (const Lanes& along : slope.step) CHECK(std::abs(of_white(along)) < 2e-3);
}

TEST_CASE("What a kernel tells of steps bounds what one leaves of the bias", "[analytic]") {
    // Light ends at a straight line: it is read at up to 0.4 radii from it with an error of the
    // step itself or less, beyond of a quarter.
    for (const double edge : {0.05, 0.15, 0.25, 0.35, 0.45, 0.6, 0.75, 0.9}) {
        const Gathered read = gathered_of([&](double x, double) { return x < edge ? 1.0 : 0.0; });
        const double left = std::abs(of_white(read.radiance) - of_white(read.bias) - 1.0);
        const double step = of_white(read.step[0]);
        CAPTURE(edge, left, step);
        CHECK(of_white(read.slope[0]) < 0.0);
        CHECK((step < 0.0) == (edge < 0.4));
        CHECK(left <= (edge < 0.4 ? 1.0 : 0.25) * std::abs(step));
        // Twin: the measured bias alone bounds it only from 0.3 radii on.
        CHECK((left > 0.5 * std::abs(of_white(read.bias))) == (edge < 0.3));
    }
}

TEST_CASE("What two radii tell of the kernel bias is exact at the edge of a slope", "[analytic]") {
    // Half of a disc on a field E(x) = 1 + g x has the mean 1 + g 4 r / (3 pi). In a whole disc the
    // mean is 1, whatever g.
    const double radius_m = 0.1, g = 3.0;
    const KernelAreas half{pi * radius_m * radius_m / 2.0, pi * radius_m * radius_m / 4.0};
    const KernelAreas whole{2.0 * half.full, 2.0 * half.inner};
    const auto mean = [&](double r) { return 1.0 + g * 4.0 * r / (3.0 * pi); };
    KernelSums sums;
    sums.full = Lanes::Constant(static_cast<float>(mean(radius_m) * half.full));
    sums.narrow =
        Lanes::Constant(static_cast<float>(mean(inner_radius_factor * radius_m) * half.inner));
    const Gathered gathered = sums.over(half, radius_m, 1.0);
    CHECK_THAT(static_cast<double>(gathered.radiance[0] - gathered.bias[0]), WithinRel(1.0, 1e-5));
    CHECK_THAT(bias_per_difference(whole, radius_m), WithinRel(2.0, 1e-12));
    CHECK_THAT(bias_per_difference({half.full / 2.0, half.inner / 2.0}, radius_m),
               WithinRel(2.0 + std::numbers::sqrt2, 1e-12));  // a corner
}
