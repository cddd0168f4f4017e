// Image sources: each reflection in a plane mirror adds a source behind it, times the reflectance.
#include <fmt/format.h>

#include <functional>

#include "validation/cases.h"
#include "validation/scene_builder.h"
#include "validation/truth/polygon_light.h"
#include "validation/truth/quadrature.h"

namespace lucerna::validation {
namespace {

using namespace optics;

// What a camera straight above sees of the floor, a square around `middle`.
constexpr double half_width_m = 0.4;
constexpr double floor_rho = 0.5;

using Illuminance = std::function<double(const Vec3&)>;

// Light that the floor reflects goes up, also by way of the mirrors, and never returns.
Check mean_luminance(SceneBuilder& scene, const Vec3& middle, const Illuminance& illuminance) {
    const double height_m = 3.0;
    scene.camera(middle + height_m * Vec3::UnitZ(), middle, Vec3::UnitY(),
                 2.0 * std::atan(half_width_m / height_m), 24, 24);
    const double flux = truth::integral(
        [&](double s) {
            return truth::integral([&](double t) { return illuminance(middle + Vec3(s, t, 0.0)); },
                                   -half_width_m, half_width_m, 2);
        },
        -half_width_m, half_width_m, 2);
    const double value = floor_rho / pi * flux / (4.0 * half_width_m * half_width_m);
    return {"mean over 0.8 x 0.8 m of the floor",
            "luminance",
            "cd/m2",
            value,
            1e-5 * value,
            image_mean(0),
            0.01};
}

const std::string source = "sum over image sources, each times the product of its reflectances";

// A source that can be moved and mirrored: as a light, and what it gives at x.
struct Lamp {
    std::string name;
    Rectangle shape;  ///< of area 0: a point at its corner

    void add_to(SceneBuilder& scene) const {
        if (shape.edge_u.isZero()) {
            scene.light("lamp", PointLight{shape.corner}, 4.0 * pi * intensity);
        } else {
            scene.area_light(scene.object("lamp", shape, scene.black()), luminance);
        }
    }
    // From the image of the lamp whose points are at sign * x + shift_m.
    double illuminance(const Vec3& at, double sign, double shift_m) const {
        const auto image = [&](const Vec3& p) {
            return Vec3(sign * p.x() + shift_m, p.y(), p.z());
        };
        if (shape.edge_u.isZero()) {
            const Vec3 way = image(shape.corner) - at;
            return intensity * way.z() / std::pow(way.norm(), 3);
        }
        std::vector<Vec3> polygon = truth::corners(shape.corner, shape.edge_u, shape.edge_v);
        for (Vec3& p : polygon) p = image(p);
        return truth::polygon_illuminance(polygon, luminance, at, Vec3::UnitZ());
    }

    static constexpr double intensity = 100.0;   // cd
    static constexpr double luminance = 1000.0;  // cd/m2
};

const Lamp point{"point source", {{0.4, 0.0, 1.0}, Vec3::Zero(), Vec3::Zero()}};
const Lamp panel{"luminous rectangle", {{0.05, -0.2, 1.0}, {0.0, 0.4, 0.0}, {0.3, 0.0, 0.0}}};

void add_floor_and_mirror(SceneBuilder& scene, double x_m, double rho) {
    scene.object("floor", Rectangle{{-3, -4, 0}, {x_m + 3, 0, 0}, {0, 8, 0}},
                 scene.diffuse(floor_rho));
    scene.object("mirror", Rectangle{{x_m, -4, 0}, {0, 0, 4}, {0, 8, 0}}, scene.mirror(rho));
}

Case one_mirror(const std::string& id, const Lamp& lamp, double rho,
                const optics::Settings& settings = effort(32, 40000, 4)) {
    constexpr double mirror_x_m = 1.2;
    SceneBuilder scene;
    add_floor_and_mirror(scene, mirror_x_m, rho);
    lamp.add_to(scene);
    Check check = mean_luminance(scene, {0.75, 0.0, 0.0}, [&](const Vec3& x) {
        return lamp.illuminance(x, 1.0, 0.0) + rho * lamp.illuminance(x, -1.0, 2.0 * mirror_x_m);
    });
    return {id,       fmt::format("{} before a mirror of reflectance {:g}", lamp.name, rho),
            source,   scene.parts,
            settings, {check}};
}

// Mirrors at x = 0 and x = a. Images at 2 n a + x by |2 n| reflections, at 2 n a - x by |2 n - 1|.
Case two_mirrors(const std::string& id, const Lamp& lamp, double rho,
                 const optics::Settings& settings = effort(32, 30000, 4)) {
    constexpr double apart_m = 1.2;
    SceneBuilder scene;
    add_floor_and_mirror(scene, apart_m, rho);
    scene.object("mirror", Rectangle{{0, -4, 0}, {0, 8, 0}, {0, 0, 4}}, scene.mirror(rho));
    lamp.add_to(scene);
    Check check = mean_luminance(scene, {0.75, 0.0, 0.0}, [&](const Vec3& x) {
        double sum = 0.0;
        for (int n = -60; n <= 60; ++n) {
            sum +=
                std::pow(rho, std::abs(2 * n)) * lamp.illuminance(x, 1.0, 2.0 * n * apart_m) +
                std::pow(rho, std::abs(2 * n - 1)) * lamp.illuminance(x, -1.0, 2.0 * n * apart_m);
        }
        return sum;
    });
    return {id,
            fmt::format("{} between two parallel mirrors of reflectance {:g}", lamp.name, rho),
            source,
            scene.parts,
            settings,
            {check}};
}

}  // namespace

std::vector<Case> mirrors_cases() {
    return {one_mirror("mirrors/one-point", point, 0.9),
            one_mirror("mirrors/one-rectangle", panel, 0.9),
            one_mirror("mirrors/one-weak", point, 0.3),
            two_mirrors("mirrors/two-point", point, 0.9),
            two_mirrors("mirrors/two-rectangle", panel, 0.9),
            two_mirrors("mirrors/two-weak", point, 0.5)};
}

Case drawn_mirrors(const std::string& id, Draw& draw) {
    Lamp lamp{"point source",
              {{draw.between(0.05, 1.15), draw.between(-0.5, 0.5), draw.between(0.5, 2.0)},
               Vec3::Zero(),
               Vec3::Zero()}};
    if (draw.happens(0.5)) {
        lamp.name = "luminous rectangle";
        // Out of the camera's view.
        lamp.shape.corner.x() = draw.between(0.02, 0.2);
        lamp.shape.edge_u = draw.between(0.1, 0.8) * Vec3::UnitY();
        lamp.shape.edge_v = draw.between(0.05, 0.2) * Vec3::UnitX();
    }
    const double rho = draw.between(0.1, 0.9);
    return draw.happens(0.5) ? one_mirror(id, lamp, rho, {}) : two_mirrors(id, lamp, rho, {});
}

}  // namespace lucerna::validation
