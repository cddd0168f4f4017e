#include <catch2/catch.hpp>

#include "light_checks.h"
#include "optics/light/luminous_faces.h"
#include "optics/light/opening.h"

using namespace lucerna;
using namespace lucerna::optics;
using Catch::Matchers::WithinRel;
using Kind = Opening::Kind;
using Axis = Opening::Axis;

namespace {

Opening box(double x, double y, double z, std::array<double, 4> heights) {
    return {Kind::box, {x, y, z}, Axis::z, heights};
}

double projected(const Opening& opening, const Vec3& direction) {
    return LuminousFaces(*opening_mesh(opening)).projected_area_m2(direction.normalized());
}

}  // namespace

TEST_CASE("A point has no mesh", "[light][unit]") {
    CHECK_FALSE(opening_mesh(Opening{}));
}

TEST_CASE("Flat openings are one sheet with the area of their shape", "[light][unit]") {
    const Opening rectangle{Kind::rectangle, {0.6, 1.2, 0.0}};
    const Opening ellipse{Kind::ellipse, {0.6, 1.2, 0.0}};
    CHECK_THAT(projected(rectangle, -Vec3::UnitZ()), WithinRel(0.72, 1e-12));
    CHECK_THAT(projected(ellipse, -Vec3::UnitZ()), WithinRel(pi / 4.0 * 0.72, 1e-12));
    CHECK_THAT(projected(rectangle, Vec3(1, 0, 1)), WithinRel(0.72 * std::sqrt(0.5), 1e-12));
    const Mesh mesh = *opening_mesh(rectangle);
    const auto& [a, b, c] = mesh.triangles.front();
    const Vec3 normal =
        (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]);
    CHECK(normal.normalized().z() == -1.0);
    const Opening upright{Kind::ellipse, {0.0, 0.4, 0.2}, Axis::x};
    CHECK_THAT(projected(upright, Vec3::UnitX()), WithinRel(pi / 4.0 * 0.08, 1e-12));
}

TEST_CASE("Projected areas of boxes are those of their luminous faces", "[light][analytic]") {
    const double x = 0.3, y = 1.2, h = 0.05;
    const Opening whole = box(x, y, h, {h, h, h, h});
    // Bottom x y cos(gamma), sides (y h |cos C| + x h |sin C|) sin(gamma).
    for (const double gamma : {0.0, 0.4, 1.2, 1.5, 2.6}) {
        for (const double c : {0.1, 1.5, 3.3, 5.0}) {
            const Vec3 w(std::sin(gamma) * std::cos(c), std::sin(gamma) * std::sin(c),
                         -std::cos(gamma));
            const double sides =
                (y * h * std::abs(std::cos(c)) + x * h * std::abs(std::sin(c))) * std::sin(gamma);
            const double truth = x * y * std::abs(std::cos(gamma)) + sides;
            CHECK_THAT(projected(whole, w), WithinRel(truth, 1e-12));
        }
    }
    // Four different sides: each is seen from its own half space with its own height.
    const Opening uneven = box(x, y, 0.04, {0.01, 0.02, 0.03, 0.04});
    CHECK_THAT(projected(uneven, Vec3::UnitX()), WithinRel(y * 0.01, 1e-12));
    CHECK_THAT(projected(uneven, Vec3::UnitY()), WithinRel(x * 0.02, 1e-12));
    CHECK_THAT(projected(uneven, -Vec3::UnitX()), WithinRel(y * 0.03, 1e-12));
    CHECK_THAT(projected(uneven, -Vec3::UnitY()), WithinRel(x * 0.04, 1e-12));
    const Opening dark_ends = box(x, y, h, {h, 0.0, h, 0.0});
    CHECK(projected(dark_ends, Vec3::UnitY()) < 1e-15);
}

TEST_CASE("Round bodies have the projected area of the true shape within their facets",
          "[light][analytic]") {
    const Opening upright{Kind::cylinder, {0.4, 0.4, 0.1}};
    CHECK_THAT(projected(upright, -Vec3::UnitZ()), WithinRel(pi * 0.04, 1e-12));
    CHECK_THAT(projected(upright, Vec3::UnitX()), WithinRel(0.4 * 0.1, 3e-3));
    const Opening along_x{Kind::cylinder, {1.0, 0.1, 0.1}, Axis::x};
    CHECK_THAT(projected(along_x, Vec3::UnitX()), WithinRel(pi * 0.0025, 1e-12));
    CHECK_THAT(projected(along_x, -Vec3::UnitZ()), WithinRel(0.1, 3e-3));
    const Opening sphere{Kind::ellipsoid, {0.2, 0.2, 0.2}};
    for (std::uint32_t i = 0; i < 50; ++i) {
        const auto u = test::uniforms(i);
        const Vec3 w(u[0] - 0.5, u[1] - 0.5, u[2] - 0.5);
        CHECK_THAT(projected(sphere, w), WithinRel(pi * 0.01, 1e-2));
    }
    const Opening ellipsoid{Kind::ellipsoid, {0.2, 0.4, 0.6}};
    CHECK_THAT(projected(ellipsoid, Vec3::UnitX()), WithinRel(pi / 4.0 * 0.24, 2e-2));
    CHECK_THAT(projected(ellipsoid, Vec3::UnitZ()), WithinRel(pi / 4.0 * 0.08, 2e-2));
}

TEST_CASE("Closed openings enclose a volume, all faces outward", "[light][property]") {
    const auto volume_m3 = [](const Mesh& mesh) {  // divergence theorem
        double sum = 0.0;
        for (const auto& [a, b, c] : mesh.triangles) {
            sum += mesh.vertices[a].dot(mesh.vertices[b].cross(mesh.vertices[c])) / 6.0;
        }
        return sum;
    };
    CHECK_THAT(volume_m3(*opening_mesh(box(0.3, 1.2, 0.05, {0.05, 0.05, 0.05, 0.05}))),
               WithinRel(0.3 * 1.2 * 0.05, 1e-12));
    for (const Axis axis : {Axis::x, Axis::y, Axis::z}) {
        const Opening cylinder{Kind::cylinder, {0.4, 0.6, 0.5}, axis};
        CHECK_THAT(volume_m3(*opening_mesh(cylinder)),
                   WithinRel(pi / 4.0 * 0.4 * 0.6 * 0.5, 1e-12));
    }
    CHECK_THAT(volume_m3(*opening_mesh({Kind::ellipsoid, {0.2, 0.4, 0.6}})),
               WithinRel(pi / 6.0 * 0.2 * 0.4 * 0.6, 1e-2));
}

TEST_CASE("An opening that is not convex is refused", "[light][unit]") {
    Mesh mesh;
    mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    mesh.triangles = {{0, 1, 2}, {0, 1, 3}};  // a folded sheet, one face inward
    CHECK_THROWS_AS(LuminousFaces(mesh), std::invalid_argument);
}
