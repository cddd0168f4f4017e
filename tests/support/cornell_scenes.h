// Two grey Cornell boxes of one metre (y up, front open), diffuse and with caustics.
#pragma once

#include "validation/scene_builder.h"

namespace lucerna::test {

using validation::SceneBuilder;

inline void cornell_room(SceneBuilder& scene, double light_side_m, double luminance, int pixels) {
    using optics::Rectangle;
    const Vec3 ex = Vec3::UnitX(), ey = Vec3::UnitY(), ez = Vec3::UnitZ(), o = Vec3::Zero();
    const optics::BsdfId white = scene.diffuse(0.75);
    scene.object("floor", Rectangle{o, ez, ex}, white);
    scene.object("ceiling", Rectangle{ey, ex, ez}, white);
    scene.object("back", Rectangle{o, ex, ey}, white);
    scene.object("left", Rectangle{o, ey, ez}, scene.diffuse(0.5));
    scene.object("right", Rectangle{ex, ez, ey}, scene.diffuse(0.25));
    const double a = light_side_m;
    scene.area_light(
        scene.object("lamp", Rectangle{Vec3(0.5 - a / 2, 0.999, 0.5 - a / 2), a * ex, a * ez},
                     scene.black()),
        luminance);
    if (pixels > 0) {
        scene.camera({0.5, 0.5, 2.4}, {0.5, 0.5, 0.0}, ey, 39.0 * pi / 180.0, pixels, pixels);
    }
}

inline optics::Box standing_box(const Vec3& centre, const Vec3& size, double turn_deg) {
    Placement placement = Placement::Identity();
    placement.translate(centre);
    placement.rotate(Eigen::AngleAxisd(turn_deg * pi / 180.0, Vec3::UnitY()));
    placement.translate(-0.5 * size);
    return {placement, size};
}

inline SceneBuilder cornell_diffuse(int pixels) {
    SceneBuilder scene;
    cornell_room(scene, 0.3, 1.0, pixels);
    const optics::BsdfId white = scene.diffuse(0.75);
    scene.object("small box", standing_box({0.66, 0.15, 0.65}, {0.3, 0.3, 0.3}, 17.0), white);
    scene.object("tall box", standing_box({0.33, 0.30, 0.33}, {0.3, 0.6, 0.3}, -17.0), white);
    return scene;
}

inline SceneBuilder cornell_caustic(int pixels) {
    SceneBuilder scene;
    cornell_room(scene, 0.1, 9.0, pixels);
    scene.solid("glass", optics::Sphere{{0.68, 0.19, 0.62}, 0.18}, scene.medium(1.5));
    scene.object("mirror", optics::Sphere{{0.30, 0.19, 0.38}, 0.18}, scene.mirror(0.95));
    return scene;
}

}  // namespace lucerna::test
