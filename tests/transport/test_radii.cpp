// How wide the kernels are that sensors read caustics with.
#include "optics/transport/sensor_radii.h"
#include "tests/support/truth_checks.h"

using namespace lucerna;
using namespace lucerna::optics;
using test::SceneBuilder;

namespace {

constexpr double margin_m = 1.0;

/// An illuminance point at the origin, nothing near it.
struct OnePoint {
    SceneBuilder scene = [] {
        SceneBuilder builder;
        builder.object("floor", Rectangle{{-1, -1, -9}, {2, 0, 0}, {0, 2, 0}}, builder.black());
        builder.light("light", PointLight{{0, 0, 3}}, 1.0);
        builder.points({Vec3::Zero()}, Vec3::UnitZ());
        return builder;
    }();
    Stage stage{scene.parts};
    SensorPlanes planes{stage.parts(), stage.caster(), margin_m};

    float flux_in_corners = 1.0f;  // of the photons that no kernel reaches, others have 1

    enum class Light { within, outside, on_one_side, in_rings };

    /// Photons at random in a square around the point, as dense as `photons` in the unit disk;
    /// beyond the edge there are none. That is a circle, of which the inside may be dark instead
    /// but for one photon in a hundred, or a straight line. In rings, the irradiance is 1 around
    /// the point, and such beyond that the unit disk and the one of half its area both hold 1.52.
    PilotPhotons pilot(std::uint32_t number, double photons, double edge_m, Light light) const {
        PilotPhotons result{{}, 1000, Lanes::Ones()};
        const auto count = static_cast<std::uint32_t>(photons * 4.0 / pi);
        for (std::uint32_t i = 0; i < count; ++i) {
            RandomStream random(1, number, RandomPurpose::test, i);
            const double x = 2.0 * random.uniform() - 1.0;
            const Vec3 at(x, 2.0 * random.uniform() - 1.0, 0.0);
            const double square = at.squaredNorm();
            const double of_ring = square < 0.16   ? 1.0
                                   : square < 0.36 ? 3.0
                                   : square < 0.5  ? 0.0
                                                   : 1.52;
            const bool dark = light == Light::in_rings  ? 3.0 * random.uniform() > of_ring
                              : light == Light::within  ? at.norm() > edge_m
                              : light == Light::outside ? at.norm() < edge_m && i % 100
                                                        : x > edge_m;
            if (dark) continue;
            result.photons.push_back(
                {{at, Vec3::UnitZ(), no_object, 0, 0},
                 -Vec3::UnitZ(),
                 Lanes::Constant(at.norm() > margin_m ? flux_in_corners : 1.0f),
                 History::caustic});
        }
        return result;
    }

    double radius_m(double edge_m, double photons = 20000.0, Light light = Light::within) const {
        const Radii narrow(std::vector<double>(stage.patch_count() + 1, 1e-3));
        const SurfacePoint point{Vec3::Zero(), Vec3::UnitZ(), no_object, 0, 0};
        const std::vector<ReadPoint> points{{point, 0}};
        return widened_around(stage, planes, narrow, pilot(1, photons, edge_m, light),
                              pilot(2, photons, edge_m, light), points, 0.05, 1000, 1)
            .of_point(0);
    }
};

}  // namespace

TEST_CASE("A kernel of a sensor is as wide as light is even around it") {
    const OnePoint room;
    CHECK(room.radius_m(infinity) > 0.99 * margin_m);
    // An edge at a distance d: the widest of the radii 1, 1 / sqrt 2, 1 / 2, ... that does not
    // reach it, or the next one.
    for (const double edge_m : {0.6, 0.4, 0.15}) {
        INFO("edge at " << edge_m << " m, radius " << room.radius_m(edge_m) << " m");
        CHECK(room.radius_m(edge_m) <= edge_m);
        CHECK(room.radius_m(edge_m) > 0.5 * edge_m);
    }
    // A dark place in bright light: a kernel that takes some of that in has more photons, but they
    // are not those of the place.
    for (const double edge_m : {0.6, 0.3}) {
        const double radius_m = room.radius_m(edge_m, 20000.0, OnePoint::Light::outside);
        INFO("bright beyond " << edge_m << " m, radius " << radius_m << " m");
        CHECK(radius_m <= edge_m);
        CHECK(radius_m > 0.35 * edge_m);
    }
    // A straight edge close to the point, as of a sharp shadow: half of a wide disc is dark, and
    // half of any narrower one, so that no two radii tell that the point is bright.
    for (const double edge_m : {0.1, 0.05}) {
        const double radius_m = room.radius_m(edge_m, 20000.0, OnePoint::Light::on_one_side);
        INFO("shadow beyond " << edge_m << " m, radius " << radius_m << " m");
        CHECK(radius_m <= 2.0 * edge_m);
        CHECK(radius_m > 0.25 * edge_m);
    }
    // An edge and a hollow that hide each other in the widest kernel show in the next narrower
    // ones.
    const double in_rings_m = room.radius_m(infinity, 60000.0, OnePoint::Light::in_rings);
    INFO("rings beyond 0.4 m, radius " << in_rings_m << " m");
    CHECK(in_rings_m <= 0.4);
    CHECK(in_rings_m > 0.15);
    // Guided rays leave photons of little flux where they are wanted, and heavy ones elsewhere.
    const OnePoint guided{.flux_in_corners = 1e4f};
    CHECK(guided.radius_m(0.1, 20000.0, OnePoint::Light::on_one_side) <= 0.2);
    CHECK(guided.radius_m(infinity) > 0.99 * margin_m);
    // Where the pilot finds nothing, what there is is rare: the widest kernel finds it soonest, and
    // a narrow one might state darkness with hardly any U.
    CHECK(room.radius_m(infinity, 0.0) > 0.99 * margin_m);
}

TEST_CASE("Few photons on a small thing: kernels are as wide as its patch allows") {
    SceneBuilder scene;
    const double radius_m = 0.01;
    scene.object("dot", Disk{Vec3::Zero(), Vec3::UnitZ(), radius_m}, scene.black());
    scene.object("ball", Sphere{{0.5, 0, 0}, radius_m}, scene.black());
    scene.object("floor", Rectangle{{-1, -1, -1}, {2, 0, 0}, {0, 2, 0}}, scene.black());
    scene.light("light", PointLight{{0, 0, 3}}, 1.0);
    scene.points({Vec3::Zero()}, Vec3::UnitZ());
    const Stage stage{scene.parts};
    const SensorPlanes planes{stage.parts(), stage.caster(), margin_m};
    // 30 on each: no kernel holds as many as are wanted.
    PilotPhotons pilot{{}, 1000, Lanes::Ones()};
    for (std::uint32_t i = 0; i < 60; ++i) {
        RandomStream random(1, 0, RandomPurpose::test, i);
        SurfacePoint point =
            sample_area(stage.parts().objects[i % 2].shape, random.uniform(), random.uniform());
        point.object = i % 2;
        pilot.photons.push_back({point, -point.normal, Lanes::Ones(), History::caustic});
    }
    const double dot_m = std::sqrt(pi) * radius_m, ball_m = std::sqrt(4.0 * pi) * radius_m;
    const Radii seen = narrow_radii(stage, planes, pilot, {100.0, 100.0}, 1000, true, 1);
    CHECK(seen[0] == Approx(dot_m / 4.0));
    CHECK(seen[1] == Approx(ball_m / 8.0));
    const Radii wide = wide_radii(stage, planes, pilot, 1);
    CHECK(wide[0] == Approx(dot_m / 4.0));
    CHECK(wide[1] == Approx(ball_m / 8.0));
    const Radii hidden = narrow_radii(stage, planes, pilot, {100.0, 100.0}, 1000, false, 1);
    CHECK(hidden[0] == Approx(dot_m / 8.0));
}
