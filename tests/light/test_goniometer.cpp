#include <catch2/catch.hpp>

#include "light_checks.h"
#include "optics/light/goniometer.h"

using namespace lucerna;
using namespace lucerna::optics;

TEST_CASE("The axes of types A and B are those of LM-63-2002", "[light][unit]") {
    const auto near = [](const Vec3& a, const Vec3& b) { return (a - b).norm() < 1e-15; };
    const Vec3 photometric_horizontal = Vec3::UnitX();
    const Vec3 nadir = -Vec3::UnitZ();
    CHECK(near(type_a_direction({0, 0}), photometric_horizontal));
    CHECK(near(type_a_direction({0, -90}), nadir));
    CHECK(near(type_b_direction({0, 90}), photometric_horizontal));
    CHECK(near(type_b_direction({0, 0}), nadir));
    // H turns clockwise, seen from above: from +x toward -y.
    CHECK(near(type_a_direction({90, 0}), -Vec3::UnitY()));
    CHECK(near(type_b_direction({90, 90}), -Vec3::UnitY()));
}

TEST_CASE("Angles of types A and B and directions are inverse", "[light][property]") {
    for (std::uint32_t i = 0; i < 200; ++i) {
        const auto u = test::uniforms(i);
        const Vec3 d = Vec3(u[0] - 0.5, u[1] - 0.5, u[2] - 0.5).normalized();
        CHECK((type_a_direction(type_a_angles(d)) - d).norm() < 1e-14);
        CHECK((type_b_direction(type_b_angles(d)) - d).norm() < 1e-14);
    }
}
