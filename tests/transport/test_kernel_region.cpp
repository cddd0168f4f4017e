// Kernels beside objects that stand on a surface.
#include "optics/transport/forward_map.h"
#include "optics/transport/path.h"
#include "tests/support/mesh_shapes.h"
#include "tests/support/truth_checks.h"

using namespace lucerna;
using namespace lucerna::optics;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;
using validation::SceneBuilder;

namespace {

constexpr double kernel_m = 0.1;
constexpr double disc_m2 = pi * kernel_m * kernel_m;

// A plate of 1 m x 1 m with a block on it, turned by 30 degrees, whose left side runs through
// (0.5, 0.5).
const double turn_rad = 30.0 * rad_per_deg;
const Vec2 from_block(-std::cos(turn_rad), -std::sin(turn_rad));  // normal of that side

Placement block_placement() {
    Placement placement = Placement::Identity();
    placement.translate(Vec3(0.5, 0.5, 0.0));
    placement.rotate(Eigen::AngleAxisd(turn_rad, Vec3::UnitZ()));
    placement.translate(Vec3(0.0, -0.2, 0.0));
    return placement;
}

struct PlateAndBlock {
    SceneBuilder scene;
    BsdfId paint = scene.diffuse(0.5);
    ObjectId plate = scene.object("plate", Rectangle{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, paint);
    ObjectId block = scene.object("block", Box{block_placement(), {0.4, 0.4, 0.3}}, paint);

    PlateAndBlock() {
        scene.light("light", PointLight{{0, 0, 1}}, 1.0);
        scene.receiver(plate);
    }
    SurfacePoint at(const Vec2& p) const { return {{p.x(), p.y(), 0}, Vec3::UnitZ(), plate}; }
};

// The point of the plate below.
SurfacePoint below(const Stage& stage, double x, double y) {
    const auto hit = stage.caster().intersect({{x, y, 0.2}, -Vec3::UnitZ()}, nullptr);
    REQUIRE(hit);
    return hit->point;
}

// A plate of that shape with a block on it, under a lamp.
SceneBuilder plate_with_block(const Shape& plate, const Vec3& corner, const Vec3& size_m) {
    SceneBuilder scene;
    const BsdfId paint = scene.diffuse(0.5);
    scene.object("plate", plate, paint);
    scene.object("block", Box{Placement(Eigen::Translation3d(corner)), size_m}, paint);
    scene.light("light", PointLight{{0, 0, 1}}, 1.0);
    scene.receiver(0);
    return scene;
}

// Of the disc on one side of a chord at a distance from its centre.
double large_part_m2(double distance_m, double radius) {
    const double a = std::acos(distance_m / radius);
    return pi * radius * radius - radius * radius * (a - std::sin(a) * std::cos(a));
}

}  // namespace

TEST_CASE("A kernel ends at the foot of what stands on the surface", "[analytic]") {
    const PlateAndBlock of;
    const Stage stage(of.scene.parts);
    for (const double distance_m : {0.001, 0.03, 0.06, 0.09}) {
        INFO(distance_m);
        const Vec2 p = Vec2(0.5, 0.5) + distance_m * from_block;
        const auto region = KernelRegion::within(stage, of.at(p), Vec3::UnitZ(), kernel_m);
        REQUIRE(region);

        const double truth_m2 = large_part_m2(distance_m, kernel_m);
        CHECK_THAT(region->area_m2(kernel_m), WithinAbs(truth_m2, 0.005 * disc_m2));
        const double inner_m = inner_radius_factor * kernel_m;
        if (distance_m < inner_m) {
            CHECK_THAT(region->area_m2(inner_m),
                       WithinAbs(large_part_m2(distance_m, inner_m), 0.005 * disc_m2));
        }
        // It holds what its area says, and hardly anything beyond the foot.
        int held = 0, beyond = 0;
        constexpr int steps = 400;
        for (int i = 0; i < steps; ++i) {
            for (int j = 0; j < steps; ++j) {
                const Vec2 offset((2.0 * (i + 0.5) / steps - 1.0) * kernel_m,
                                  (2.0 * (j + 0.5) / steps - 1.0) * kernel_m);
                if (offset.norm() >= kernel_m) continue;
                const Vec2 q = p + offset;
                if (!region->holds({q.x(), q.y(), 0.0})) continue;
                ++held;
                beyond += (q - Vec2(0.5, 0.5)).dot(from_block) < 0.0 ? 1 : 0;
            }
        }
        const double cell_m2 = square(2.0 * kernel_m / steps);
        CHECK_THAT(held * cell_m2, WithinAbs(region->area_m2(kernel_m), 1e-3 * disc_m2));
        CHECK(beyond * cell_m2 < 0.002 * disc_m2);
        CHECK(disc_m2 - truth_m2 > 0.01 * disc_m2);  // the twin: there is something beyond
    }
    CHECK_FALSE(KernelRegion::within(stage, of.at({0.2, 0.2}), Vec3::UnitZ(), kernel_m));
    // Nothing stands on the back of the plate.
    CHECK_FALSE(KernelRegion::within(stage, of.at({0.49, 0.5}), -Vec3::UnitZ(), kernel_m));
}

TEST_CASE("A kernel on a flat part of a mesh ends at the foot", "[analytic]") {
    SceneBuilder scene;
    Placement placement = Placement::Identity();
    placement.translate(Vec3(0.0, 0.0, -0.1));
    scene.object("plate", MeshInstance{test::box_mesh({1.0, 1.0, 0.1}, 7), placement},
                 scene.diffuse(0.5));
    scene.object("block", Box{block_placement(), {0.4, 0.4, 0.3}}, scene.diffuse(0.5));
    scene.light("light", PointLight{{0, 0, 1}}, 1.0);
    scene.receiver(0);
    const Stage stage(scene.parts);
    const auto area_m2 = [&](const Vec2& p) {
        const auto region =
            KernelRegion::within(stage, below(stage, p.x(), p.y()), Vec3::UnitZ(), kernel_m);
        return region ? region->area_m2(kernel_m) : 0.0;
    };
    CHECK_THAT(area_m2(Vec2(0.5, 0.5) + 0.03 * from_block),
               WithinAbs(large_part_m2(0.03, kernel_m), 0.005 * disc_m2));
    CHECK(area_m2({0.2, 0.2}) == 0.0);
    CHECK(area_m2({0.05, 0.5}) == 0.0);  // no barrier
}

TEST_CASE("A kernel ends at the foot and at the edge of the surface", "[analytic]") {
    const Placement lowered(Eigen::Translation3d(0.0, 0.0, -0.1));
    const Shape plate =
        GENERATE_COPY(Shape(Rectangle{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}),
                      Shape(MeshInstance{test::box_mesh({1.0, 1.0, 0.1}, 1), lowered}),
                      Shape(MeshInstance{test::box_mesh({1.0, 1.0, 0.1}, 7), lowered}));
    const SceneBuilder scene = plate_with_block(plate, {0.5, 0.0, 0.0}, {0.2, 1.0, 0.3});
    const Stage stage(scene.parts);
    const auto region =
        KernelRegion::within(stage, below(stage, 0.4999, 0.0001), Vec3::UnitZ(), kernel_m);
    REQUIRE(region);
    CHECK_THAT(region->area_m2(kernel_m), WithinRel(disc_m2 / 4.0, 0.005));
}

TEST_CASE("A kernel runs on where a corner of its mesh reaches into it", "[analytic]") {
    // An L whose corner is at (0.5, 0.5), and a block on its foot close by.
    std::vector<Vec3> vertices{{0, 0, 0},     {0.5, 0, 0}, {1, 0, 0}, {0, 0.5, 0},
                               {0.5, 0.5, 0}, {1, 0.5, 0}, {0, 1, 0}, {0.5, 1, 0}};
    const auto mesh =
        prepare_mesh(vertices, {{0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}, {3, 4, 7}, {3, 7, 6}});
    const SceneBuilder scene = plate_with_block(MeshInstance{mesh, Placement::Identity()},
                                                {0.0, 0.42, 0.0}, {0.45, 0.05, 0.3});
    const Stage stage(scene.parts);
    const auto region_at = [&](double x, double y) {
        return KernelRegion::within(stage, below(stage, x, y), Vec3::UnitZ(), kernel_m);
    };
    CHECK_FALSE(region_at(0.48, 0.48));
    // The twin: beside the same block, the corner out of reach.
    CHECK(region_at(0.2, 0.48));
    CHECK(region_at(0.48, 0.36));
}

TEST_CASE("A flat mesh with few digits gathers all photons around a point", "[analytic]") {
    // At heights of up to a millionth above and below where cells of the grid meet.
    constexpr double radius_m = 0.004, six_digits = 1e-6, height_m = 0.63 * radius_m;
    auto vertices = test::box_mesh({1.0, 1.0, 0.1}, 7)->vertices;
    const auto triangles = test::box_mesh({1.0, 1.0, 0.1}, 7)->triangles;
    for (Vec3& vertex : vertices) {
        // The same for all vertices at a place.
        vertex.z() += six_digits * std::sin(1e3 * vertex.x() + 2e3 * vertex.y()) - 0.1 + height_m;
    }
    SceneBuilder scene;
    const BsdfId paint = scene.diffuse(0.5);
    scene.object("plate", MeshInstance{prepare_mesh(vertices, triangles), Placement::Identity()},
                 paint);
    scene.light("light", PointLight{{0, 0, 1}}, 1.0);
    scene.receiver(0);
    const Stage stage(scene.parts);
    const Phase phase(stage, 1, 0);
    REQUIRE(stage.patch_is_plane(stage.patch_index(below(stage, 0.5, 0.5))));
    std::vector<Photon> photons;
    for (int i = 0; i < 100; ++i) {
        for (int j = 0; j < 100; ++j) {
            photons.push_back({below(stage, 0.4503 + 0.00101 * i, 0.4507 + 0.00103 * j),
                               -Vec3::UnitZ(), Lanes::Constant(1.0f), History::indirect});
        }
    }
    const Radii radii(std::vector<double>(stage.patch_count(), radius_m));
    const ForwardMap map(stage, radii, {&photons, 1}, 1, 1);
    const Vec3 wo = Vec3::UnitZ();
    const SurfaceOptics optics = optics_at(phase, no_object, no_object, false, 0);
    for (int i = 0; i < 40; ++i) {
        const SurfacePoint point = below(stage, 0.47 + 0.00137 * i, 0.52 - 0.00071 * i);
        const Frame frame(point.normal);
        const GatherPoint at{point, frame, wo, stage.parts().bsdfs[paint], optics};
        const auto truth = std::ranges::count_if(photons, [&](const Photon& photon) {
            return (photon.point.position - point.position).norm() < radius_m;
        });
        CHECK(map.gather(phase, radii, at).photons == truth);
    }
}

TEST_CASE("Light beside the foot of an object is what it is elsewhere", "[analytic]") {
    // E = 1 on the plate, none under the block: L = rho / pi up to the block.
    PlateAndBlock of;
    const Stage stage(of.scene.parts);
    const Phase phase(stage, 1, 0);
    const double step_m = 0.001, rays = 5.0;
    std::vector<Photon> photons;
    for (int i = 0; i < 1000; ++i) {
        for (int j = 0; j < 1000; ++j) {
            const Vec2 q((i + 0.5) * step_m, (j + 0.5) * step_m);
            if ((q - Vec2(0.5, 0.5)).dot(from_block) < 0.0) continue;
            photons.push_back({of.at(q), -Vec3::UnitZ(),
                               Lanes::Constant(static_cast<float>(step_m * step_m * rays)),
                               History::indirect});
        }
    }
    std::vector<double> of_patches(stage.patch_count(), kernel_m);
    const Radii radii(of_patches);
    const ForwardMap map(stage, radii, {&photons, 1}, static_cast<std::uint64_t>(rays), 1);
    const Vec3 wo = Vec3::UnitZ();
    const SurfaceOptics optics = optics_at(phase, no_object, no_object, false, 0);
    double mean = 0.0, mean_without = 0.0;
    constexpr int points = 40;
    for (int i = 0; i < points; ++i) {
        const Vec2 along(-from_block.y(), from_block.x());
        const SurfacePoint point =
            of.at(Vec2(0.5, 0.5) + 0.003 * (i + 0.5) * from_block + 0.001 * i * along);
        const Frame frame(point.normal);
        const auto region = KernelRegion::within(stage, point, Vec3::UnitZ(), kernel_m);
        GatherPoint at{point, frame, wo, stage.parts().bsdfs[of.paint], optics};
        mean_without += static_cast<double>(map.gather(phase, radii, at).radiance[0]) / points;
        if (region) at.region = &*region;
        mean += static_cast<double>(map.gather(phase, radii, at).radiance[0]) / points;
    }
    CHECK_THAT(mean, WithinRel(0.5 / pi, 0.002));
    CHECK(mean_without < 0.9 * 0.5 / pi);  // the twin
}

TEST_CASE("Light does not leak through a thin wall that stands on a floor", "[analytic]") {
    // Two rooms on one floor, a lamp in the left one: the right one is dark.
    SceneBuilder scene;
    const BsdfId paint = scene.diffuse(0.7);
    for (const Shape& wall : SceneBuilder::room(2.0, 1.0, 1.0)) scene.object("wall", wall, paint);
    scene.object("thin wall", Rectangle{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, paint);
    scene.light("lamp", PointLight{{0.5, 0.5, 0.5}}, 1000.0);
    scene.meter({1.3, 0.5, 0.5}, {1.02, 0.5, 0.0}, 0.02);
    scene.meter({0.7, 0.5, 0.3}, {0.98, 0.5, 0.0}, 0.02);
    const Result result = test::run(scene, Method::forward, {32, 20000});
    CHECK(result.quantities[0].estimate.value() == 0.0);
    CHECK(result.quantities[1].estimate.value() > 1.0);
}
