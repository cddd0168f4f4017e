// Area, point and beam lights against closed forms.
#include "light_checks.h"
#include "optics/geometry/mesh.h"
#include "optics/light/light.h"

using namespace lucerna;
using namespace lucerna::optics;
using namespace lucerna::test;
using Catch::Matchers::WithinRel;

namespace {

constexpr ObjectId object = 7;

// Irradiance per flux on a plane with normal n at x: mean of factor * cos, for unit flux.
Mean irradiance(const LightSource& light, const Vec3& x, const Vec3& n, std::uint32_t count) {
    return mean_of(count, [&](const auto& u) {
        const auto sample = illuminate(light, x, u[0], u[1]);
        return sample ? sample->factor * std::max(0.0, n.dot(sample->direction)) : 0.0;
    });
}

// E / L of a Lambertian polygon: 1/2 sum of theta_i n . gamma_i (Lambert 1760; Arvo 1995, eq. 3.1).
double lambert_polygon(const std::vector<Vec3>& corners, const Vec3& x, const Vec3& n) {
    double sum = 0.0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Vec3 a = (corners[i] - x).normalized();
        const Vec3 b = (corners[(i + 1) % corners.size()] - x).normalized();
        const Vec3 cross = a.cross(b);
        sum += std::atan2(cross.norm(), a.dot(b)) * n.dot(cross.normalized());
    }
    return 0.5 * std::abs(sum);
}

const Rectangle panel{{-0.5, -0.2, 2.0}, {0.0, 0.7, 0.0}, {1.1, 0.0, 0.0}};  // normal: down

}  // namespace

TEST_CASE("A rectangle illuminates as Lambert's polygon formula says", "[light][analytic]") {
    const AreaLight light{object, panel};
    const double radiance = 1.0 / (pi * 0.77);
    const std::vector<Vec3> corners = {panel.corner, panel.corner + panel.edge_u,
                                       panel.corner + panel.edge_u + panel.edge_v,
                                       panel.corner + panel.edge_v};
    const Vec3 n = Vec3(0.3, -0.2, 1.0).normalized();
    for (const Vec3& x : {Vec3(0, 0, 0), Vec3(1.5, -0.4, 0.5), Vec3(0.1, 0.2, 1.5)}) {
        const Mean mean = irradiance(light, x, n, 400000);
        check_mean(mean.value, mean.standard_error, radiance * lambert_polygon(corners, x, n),
                   {0.03});
    }
    // Just below it, and just beside that: by solid angle, so that not a single value is far off.
    for (const Vec3& x : {Vec3(0.1, 0.2, 1.9999), Vec3(0.7, 0.2, 1.99)}) {
        const Mean mean = irradiance(light, x, Vec3::UnitZ(), 400000);
        check_mean(mean.value, mean.standard_error,
                   radiance * lambert_polygon(corners, x, Vec3::UnitZ()), {0.02});
    }
    CHECK_FALSE(illuminate(light, {0, 0, 3}, 0.5, 0.5));  // behind it
    const Mean above = irradiance(AreaLight{object, panel, true}, {0, 0, 4}, -n, 100000);
    const double truth = 0.5 * radiance * lambert_polygon(corners, {0, 0, 4}, -n);
    check_mean(above.value, above.standard_error, truth, {0.03});
    CHECK_FALSE(agrees(above.value, above.standard_error, 2.0 * truth));  // the twin
}

TEST_CASE("A disk illuminates its axis as the closed form says", "[light][analytic]") {
    const double r = 0.3;
    const AreaLight light{object, Disk{{0, 0, 1}, {0, 0, -1}, r}};
    for (const double h : {0.1, 1.0, 5.0}) {
        // E = pi L r^2 / (r^2 + h^2) and Phi = pi L pi r^2.
        const double truth = 1.0 / (pi * (r * r + h * h));
        const Mean mean = irradiance(light, {0, 0, 1 - h}, Vec3::UnitZ(), 300000);
        check_mean(mean.value, mean.standard_error, truth, {0.03});
    }
}

TEST_CASE("A sphere illuminates as the inverse square of the distance from its centre",
          "[light][analytic]") {
    const double radius = 0.4;
    const AreaLight light{object, Sphere{{1, 2, 3}, radius}};
    const Vec3 axis = Vec3(2, -1, 2) / 3.0;
    for (const double distance : {0.401, 0.5, 3.0, 1e4}) {
        const Vec3 x = Vec3(1, 2, 3) - distance * axis;
        const Mean mean = irradiance(light, x, axis, 200000);
        // For a plane that faces the centre, and wholly above its horizon: E = Phi / (4 pi d^2).
        check_mean(mean.value, mean.standard_error, 1.0 / (4.0 * pi * distance * distance), {0.02});
        const auto sample = *illuminate(light, x, 0.3, 0.6);
        const double sine = radius / distance;
        const double solid_angle = 2.0 * pi * sine * sine / (1.0 + std::sqrt(1.0 - sine * sine));
        CHECK_THAT(1.0 / sample.pdf_solid_angle, WithinRel(solid_angle, 1e-12));
        CHECK_THAT((sample.position - Vec3(1, 2, 3)).norm(), WithinRel(radius, 1e-12));
        CHECK_THAT((sample.position - x).normalized().dot(sample.direction), WithinRel(1.0, 1e-12));
    }
    CHECK_FALSE(illuminate(light, {1, 2, 3.1}, 0.5, 0.5));  // the inner side is dark
}

TEST_CASE("The inner side of a sphere illuminates every point and plane within it alike",
          "[light][analytic]") {
    const AreaLight light{object, Sphere{{0, 0, 0}, 2.0}, false, true};
    // A uniform field of radiance L: E = pi L on any plane; Phi = pi L 4 pi R^2.
    for (const Vec3& x : {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0.3, -1.2, 0.8)}) {
        const Mean mean = irradiance(light, x, Vec3(1, 1, 1).normalized(), 400000);
        check_mean(mean.value, mean.standard_error, 1.0 / (16.0 * pi), {0.03});
    }
}

TEST_CASE("Density, factor and radiance of an illumination fit together", "[light][property]") {
    const auto mesh =
        prepare_mesh({{-1, 0, 0}, {1, 0, 0}, {0, 1, 0.5}, {0, -1, 0.5}}, {{0, 1, 2}, {1, 0, 3}});
    const std::vector<AreaLight> lights = {{object, panel},
                                           {object, panel, true},
                                           {object, Disk{{0, 0, 1}, {0, 0, -1}, 0.3, 0.1}},
                                           {object, Sphere{{0, 0, 2}, 0.5}},
                                           {object, Sphere{{0, 0, 0}, 4.0}, false, true},
                                           {object, Cylinder{{0, 0, 2}, {1, 0, 2}, 0.2}},
                                           {object, Box{Placement::Identity(), {0.3, 0.2, 0.1}}},
                                           {object, MeshInstance{mesh, Placement::Identity()}}};
    int seen = 0;
    for (const AreaLight& light : lights) {
        for (std::uint32_t i = 0; i < 100; ++i) {
            const auto u = uniforms(i);
            const Vec3 x(2.0 * u[2] - 1.0, 0.3, 3.0 * u[3] - 1.5);
            const auto sample = illuminate(light, x, u[0], u[1]);
            if (!sample) continue;
            ++seen;
            CHECK(sample->surface.object == object);
            CHECK_FALSE(sample->delta);
            CHECK_THAT(illuminate_pdf_solid_angle(light, x, sample->surface),
                       WithinRel(sample->pdf_solid_angle, 1e-9));
            CHECK_THAT(radiance_factor(light, sample->surface, -sample->direction),
                       WithinRel(sample->factor * sample->pdf_solid_angle, 1e-9));
        }
    }
    CHECK(seen > 200);
}

TEST_CASE("The mean inverse density of a rectangle is its solid angle", "[light][analytic]") {
    const AreaLight light{object, Rectangle{{-0.5, -1, 1}, {0, 2, 0}, {1, 0, 0}}};
    // Solid angle from the axis: 4 asin(a b / sqrt((a^2 + d^2)(b^2 + d^2))), half sides a and b.
    const double truth = 4.0 * std::asin(0.5 / std::sqrt(1.25 * 2.0));
    const auto mean = [&](const Vec3& x) {
        return mean_of(300000, [&](const auto& u) {
            return 1.0 / illuminate(light, x, u[0], u[1])->pdf_solid_angle;
        });
    };
    // Nearby, all directions have the same density; from far away, points are uniform over the
    // area.
    CHECK_THAT(mean({0, 0, 0}).value, WithinRel(truth, 1e-9));
    const Mean far = mean({0, 0, -3});
    CHECK(far.standard_error > 0.0);
    const double truth_far = 4.0 * std::asin(0.5 / std::sqrt(16.25 * 17.0));
    check_mean(far.value, far.standard_error, truth_far, {0.001});
}

TEST_CASE("A long lamp is sampled evenly beside its end", "[light]") {
    // By its area over the squared distance of its centre, 0.02, it would pass for small; then
    // points nearby would bring 4e4 times as much as those at the other end.
    const AreaLight light{object, Rectangle{{0, -0.01, 0}, {2, 0, 0}, {0, 0.02, 0}}};
    const Vec3 x(-0.005, 0.0, 0.01);
    const double pdf = illuminate(light, x, 0.5, 0.5)->pdf_solid_angle;
    for (const double u : {0.01, 0.2, 0.9, 0.999}) {
        CHECK_THAT(illuminate(light, x, u, 1.0 - u)->pdf_solid_angle, WithinRel(pdf, 1e-12));
    }
    const Mean mean = irradiance(light, x, -Vec3::UnitZ(), 100000);
    const double truth = 1.0 / (pi * 0.04) *
                         lambert_polygon({{0, -0.01, 0}, {2, -0.01, 0}, {2, 0.01, 0}, {0, 0.01, 0}},
                                         x, Vec3::UnitZ());
    check_mean(mean.value, mean.standard_error, truth, {0.02});
}

TEST_CASE("A large rectangle is sampled within its edges, from anywhere", "[light]") {
    const Rectangle rectangle{{-0.5, -1, 1}, {0, 2, 0}, {1, 0, 0}};
    const AreaLight light{object, rectangle, true};
    for (const Vec3& x : {Vec3(0, 0, 1 - 1e-9), Vec3(0.5, 1, 1 + 1e-6), Vec3(-0.5, 0.3, 0.9),
                          Vec3(0.501, 0, 1 - 1e-7), Vec3(2, 3, 1.001), Vec3(0.1, -0.2, -0.2)}) {
        INFO(x.transpose());
        for (const double u1 : {0.0, 1e-12, 0.3, 0.5, 1.0 - 0x1p-53}) {
            for (const double u2 : {0.0, 1e-12, 0.5, 0.7, 1.0 - 0x1p-53}) {
                const auto sample = illuminate(light, x, u1, u2);
                REQUIRE(sample);
                const Vec3& p = sample->position;
                CHECK(std::abs(p.x()) <= 0.5 + 1e-12);
                CHECK(std::abs(p.y()) <= 1.0 + 1e-12);
                CHECK(std::abs(p.z() - 1.0) <= 1e-12);
                CHECK(std::isfinite(sample->factor));
                CHECK_THAT(illuminate_pdf_solid_angle(light, x, sample->surface),
                           WithinRel(sample->pdf_solid_angle, 1e-6));
            }
        }
    }
    CHECK_FALSE(illuminate(light, {0.1, 0.2, 1.0}, 0.5, 0.5));  // in its plane
}

TEST_CASE("Area lights emit by the cosine, each ray with weight 1", "[light][statistical]") {
    const auto mean_cosine = [](const AreaLight& light) {
        return mean_of(200000, [&](const auto& u) {
            const EmittedRay ray = emit(light, u[0], u[1], u[2], u[3]);
            return ray.weight == 1.0 && radiance_factor(light, ray.surface, ray.ray.direction) > 0.0
                       ? ray.surface.normal.dot(ray.ray.direction)
                       : infinity;
        });
    };
    // The mean cosine of Lambertian emission is 2/3, against the normal if inward, 0 if to both
    // sides.
    const Mean front = mean_cosine({object, panel});
    check_mean(front.value, front.standard_error, 2.0 / 3.0, {0.01});
    const Mean back = mean_cosine({object, Sphere{{0, 0, 0}, 1.0}, false, true});
    check_mean(back.value, back.standard_error, -2.0 / 3.0, {0.01});
    const Mean both = mean_cosine({object, panel, true});
    CHECK(agrees(both.value, both.standard_error, 0.0));

    // By reciprocity of emission: the flux that emitted rays bring through a far window is that
    // which illuminate() predicts. A disk of radius 0.2 m, 1 m below the panel.
    const AreaLight light{object, panel};
    const Vec3 centre(0.3, 0.1, 1.0);
    const Mean through = mean_of(1000000, [&](const auto& u) {
        const Ray ray = emit(light, u[0], u[1], u[2], u[3]).ray;
        const double t = (centre.z() - ray.origin.z()) / ray.direction.z();
        return (ray.origin + t * ray.direction - centre).norm() < 0.2 ? 1.0 : 0.0;
    });
    const Mean predicted = mean_of(400000, [&](const auto& u) {
        const double radius = 0.2 * std::sqrt(u[2]);
        const Vec3 x = centre + radius * Vec3(std::cos(2 * pi * u[3]), std::sin(2 * pi * u[3]), 0);
        const auto sample = illuminate(light, x, u[0], u[1]);
        return sample->factor * sample->direction.z() * pi * 0.04;
    });
    check_mean(through.value, std::hypot(through.standard_error, predicted.standard_error),
               predicted.value, {0.05});
}

TEST_CASE("A point light follows the inverse square law in all directions", "[light][analytic]") {
    const PointLight light{{1, 1, 1}};
    const auto sample = *illuminate(light, {1, 1, 3}, 0.5, 0.5);
    CHECK_THAT(sample.factor, WithinRel(1.0 / (16.0 * pi), 1e-14));
    CHECK(sample.delta);
    CHECK(sample.pdf_solid_angle == 0.0);
    CHECK(sample.direction == Vec3(0, 0, -1));
    CHECK(emitting_object(light) == no_object);
    const Mean up = mean_of(200000, [&](const auto& u) {
        const Vec3 w = emit(light, u[0], u[1], u[2], u[3]).ray.direction;
        return w.z() > 0.5 ? 1.0 : 0.0;
    });
    check_mean(up.value, up.standard_error, 0.25, {0.04});
}

TEST_CASE("A beam illuminates its own column and nothing else", "[light][analytic]") {
    const BeamLight round{Disk{{0, 0, 2}, {0, 0, -1}, 0.5}, {0, 0, -1}};
    const BeamLight square{Rectangle{{-1, -1, 2}, {0, 2, 0}, {2, 0, 0}}, {0, 0, -1}};
    CHECK_THAT(illuminate(round, {0.3, 0.3, 0}, 0, 0)->factor, WithinRel(4.0 / pi, 1e-14));
    CHECK_THAT(illuminate(square, {0.9, -0.9, -5}, 0, 0)->factor, WithinRel(0.25, 1e-14));
    CHECK(illuminate(square, {0.9, -0.9, -5}, 0, 0)->direction == Vec3(0, 0, 1));
    CHECK((illuminate(square, {0.9, -0.9, -5}, 0, 0)->position - Vec3(0.9, -0.9, 2)).norm() <
          1e-14);
    CHECK_FALSE(illuminate(round, {0.4, 0.4, 0}, 0, 0));
    CHECK_FALSE(illuminate(square, {1.1, 0, 0}, 0, 0));
    CHECK_FALSE(illuminate(square, {0, 0, 3}, 0, 0));  // behind the beam
    const Mean inner = mean_of(100000, [&](const auto& u) {
        const EmittedRay ray = emit(round, u[0], u[1], u[2], u[3]);
        CHECK(ray.ray.direction == Vec3(0, 0, -1));
        return (ray.ray.origin - Vec3(0, 0, 2)).norm() < 0.25 ? ray.weight : 0.0;
    });
    check_mean(inner.value, inner.standard_error, 0.25, {0.05});
}
