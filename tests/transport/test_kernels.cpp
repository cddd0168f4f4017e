// Kernels of the photon maps where the surface ends.
#include <catch2/catch.hpp>

#include "optics/transport/forward_map.h"
#include "optics/transport/path.h"
#include "validation/scene_builder.h"

using namespace lucerna;
using namespace lucerna::optics;
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

TEST_CASE("What two radii tell of the kernel bias makes a curved field exact", "[analytic]") {
    // Photons on a fine grid with E(x) = 1 - k |x - c|^2 per area: the mean over a kernel around c
    // is 1 - k r^2 / 2, and L = rho / pi times that.
    const double rho = 0.5, k = 20.0, radius_m = 0.1;
    validation::SceneBuilder scene;
    const BsdfId paint = scene.diffuse(rho);
    const ObjectId plate = scene.object("plate", Rectangle{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, paint);
    scene.light("light", PointLight{{0, 0, 1}}, 1.0);
    scene.receiver(plate);
    const Stage stage(scene.parts);
    const Phase phase(stage, 1, 0);
    const Vec3 centre(0.5, 0.4, 0.0);
    const double step_m = 0.0005, rays = 7.0;
    std::vector<Photon> photons;
    for (int i = -220; i < 220; ++i) {
        for (int j = -220; j < 220; ++j) {
            const Vec3 offset((i + 0.5) * step_m, (j + 0.5) * step_m, 0.0);
            const double flux = (1.0 - k * offset.squaredNorm()) * step_m * step_m * rays;
            photons.push_back({{centre + offset, Vec3::UnitZ(), plate},
                               -Vec3::UnitZ(),
                               Lanes::Constant(static_cast<float>(flux)),
                               History::caustic});
        }
    }
    const Radii radii({radius_m});
    const ForwardMap map(stage, radii, photons, static_cast<std::uint64_t>(rays), 1);
    const SurfacePoint point{centre, Vec3::UnitZ(), plate};
    const Frame frame(point.normal);
    const Vec3 wo = Vec3::UnitZ();
    const SurfaceOptics optics = optics_at(phase, no_object, no_object, false, 0);
    const Gathered gathered =
        map.gather(phase, radii, {point, frame, wo, stage.parts().bsdfs[paint], optics});
    const auto radiance = static_cast<double>(gathered.radiance[0]);
    const auto bias = static_cast<double>(gathered.bias[0]);
    // Cells on the rims of the kernels: about 2e-4 of each sum, and 2 % of the bias.
    CHECK_THAT(radiance, WithinRel(rho / pi * (1.0 - k * radius_m * radius_m / 2.0), 1e-3));
    CHECK_THAT(bias, WithinRel(-rho / pi * k * radius_m * radius_m / 2.0, 0.04));
    CHECK_THAT(radiance - bias, WithinRel(rho / pi, 2e-3));
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
    sums.inner =
        Lanes::Constant(static_cast<float>(mean(inner_radius_factor * radius_m) * half.inner));
    const Gathered gathered = sums.over(half, radius_m, 1.0);
    CHECK_THAT(static_cast<double>(gathered.radiance[0] - gathered.bias[0]), WithinRel(1.0, 1e-5));
    CHECK_THAT(bias_per_difference(whole, radius_m), WithinRel(2.0, 1e-12));
    CHECK_THAT(bias_per_difference({half.full / 2.0, half.inner / 2.0}, radius_m),
               WithinRel(2.0 + std::numbers::sqrt2, 1e-12));  // a corner
}
