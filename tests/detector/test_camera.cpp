// Rays of cameras and what their pixels see.
#include <catch2/catch.hpp>

#include "optics/detector/detector.h"

using namespace lucerna;
using namespace lucerna::optics;

TEST_CASE("What the pixels of a camera see of a tilted rectangle adds up to its area") {
    // At the edge of a wide view, so that neither the angle to the axis nor the tilt is small.
    const Camera camera{"wide", {1.0, 2.0, 3.0}, {1.0, 2.0, 2.0}, Vec3::UnitY(), 1.8, 600, 400};
    const CameraRays rays(camera);
    const Vec3 corner(2.5, 2.4, 0.5);
    const Vec3 first(0.9, 0.0, 0.5), second(0.0, 0.8, -0.6);
    const Vec3 normal = first.cross(second).normalized();
    const double area_m2 = first.cross(second).norm();

    double seen_m2 = 0.0, seen_at_the_middle_m2 = 0.0;
    const double side = 2.0 * std::tan(camera.horizontal_fov_rad / 2.0) / camera.width;
    for (int y = 0; y < camera.height; ++y) {
        for (int x = 0; x < camera.width; ++x) {
            const Ray ray = rays.through(x + 0.5, y + 0.5);
            const double cosine = ray.direction.dot(normal);
            const double distance_m = (corner - ray.origin).dot(normal) / cosine;
            if (distance_m <= 0.0) continue;
            const Vec3 position = ray.origin + distance_m * ray.direction;
            const Vec3 offset = position - corner;
            // first and second are not orthogonal: shares of each by the cross products.
            const double of_first = offset.cross(second).dot(normal) / area_m2;
            const double of_second = first.cross(offset).dot(normal) / area_m2;
            if (of_first < 0.0 || of_first > 1.0 || of_second < 0.0 || of_second > 1.0) continue;
            seen_m2 += rays.seen_by_pixel_m2(position, normal);
            seen_at_the_middle_m2 += side * side * distance_m * distance_m / std::abs(cosine);
        }
    }
    INFO(seen_m2 << " of " << area_m2 << " m2, " << seen_at_the_middle_m2
                 << " if all pixels had the solid angle of one at the middle");
    // A pixel at the rim counts or not, by its middle.
    CHECK(std::abs(seen_m2 / area_m2 - 1.0) < 0.01);
    CHECK(std::abs(seen_at_the_middle_m2 / area_m2 - 1.0) > 0.2);
}
