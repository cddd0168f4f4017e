// Single pixels of images as they are rendered by default, up to the edges of walls and the feet of
// what stands on them.
#include <fmt/format.h>

#include "validation/cases.h"
#include "validation/cases/panel_room.h"

namespace lucerna::validation {
namespace {

// Near edges; compared for 6 and 12, 12 and 24 cells.
constexpr double near_edges_error = 1e-3;

// A pinhole camera of its own: direction through a point of the image, x to the right and y down
// [pixels].
struct Pinhole {
    Vec3 from, to, up;
    double horizontal_fov_rad;
    int width = 14, height = 10;

    Vec3 direction(double x, double y) const {
        const Vec3 forward = (to - from).normalized();
        const Vec3 right = forward.cross(up).normalized();
        const Vec3 above = right.cross(forward);
        const double half = std::tan(horizontal_fov_rad / 2.0);
        return forward + half * (2.0 * x / width - 1.0) * right +
               half * (height - 2.0 * y) / width * above;
    }
    void add_to(SceneBuilder& scene) const {
        scene.camera(from, to, up, horizontal_fov_rad, width, height);
    }
};

optics::Settings by_default(std::uint32_t phases) {
    optics::Settings settings;
    settings.max_phases = phases;
    return settings;
}

Check pixel_check(const Pinhole& camera, int x, int y, double truth, double truth_error) {
    return {fmt::format("pixel {}, {}", x, y),
            "luminance of a pixel",
            "cd/m2",
            truth,
            truth_error,
            pixel(0, static_cast<std::size_t>(y * camera.width + x)),
            0.12};
}

// Where a ray leaves a room that holds its origin: the panel, and the point on it.
struct Seen {
    std::size_t panel = 0;
    Vec3 point = Vec3::Zero();
    double distance = infinity;
};

Seen seen(const std::vector<truth::Panel>& panels, const Vec3& from, const Vec3& direction) {
    Seen nearest;
    for (std::size_t i = 0; i < panels.size(); ++i) {
        const truth::Panel& panel = panels[i];
        const double t = (panel.plane_m - from[panel.axis]) / direction[panel.axis];
        if (!(t > 0.0) || t > nearest.distance) continue;
        const Vec3 p = from + t * direction;
        const double u = p[(panel.axis + 1) % 3], v = p[(panel.axis + 2) % 3];
        if (u < panel.span_u_m[0] || u > panel.span_u_m[1] || v < panel.span_v_m[0] ||
            v > panel.span_v_m[1]) {
            continue;
        }
        nearest = {i, p, t};
    }
    return nearest;
}

// @param fine  Where pixels are small against kernels: these are shared, and one pixel in so many
//              along each axis is checked.
Case box(int fine, std::uint32_t phases) {
    constexpr double x_m = 1.0, y_m = 1.3, z_m = 0.8;
    const std::vector<truth::Panel> panels{{0, 0.0, {0.0, y_m}, {0.0, z_m}, 0.3, 0.0},
                                           {0, x_m, {0.0, y_m}, {0.0, z_m}, 0.8, 0.0},
                                           {1, 0.0, {0.0, z_m}, {0.0, x_m}, 0.5, 0.0},
                                           {1, y_m, {0.0, z_m}, {0.0, x_m}, 0.2, 0.0},
                                           {2, 0.0, {0.0, x_m}, {0.0, y_m}, 0.65, 0.0},
                                           {2, z_m, {0.0, x_m}, {0.0, y_m / 2}, 0.6, 100.0},
                                           {2, z_m, {0.0, x_m}, {y_m / 2, y_m}, 0.6, 0.0}};
    const truth::RoomRadiosity coarse(panels, 6), finer(panels, 12);
    SceneBuilder scene;
    for (const truth::Panel& panel : panels) {
        const optics::ObjectId wall =
            scene.object("wall", rectangle(panel), scene.diffuse(panel.reflectance));
        if (panel.emitted_luminance > 0.0) scene.area_light(wall, panel.emitted_luminance);
    }
    const Pinhole camera{{0.5, 0.1, 0.45}, {0.4, 1.2, 0.3}, Vec3::UnitZ(), 1.7,
                         14 * fine,        10 * fine};
    camera.add_to(scene);

    // Means over pixels that lie on one panel, by Gauss-Legendre quadrature with 3 x 3 points.
    const double offset = std::sqrt(0.15);
    const std::array<double, 3> nodes{0.5 - offset, 0.5, 0.5 + offset};
    const std::array<double, 3> weights{5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};
    std::vector<Check> checks;
    for (int y = fine / 2; y < camera.height; y += fine) {
        for (int x = fine / 2; x < camera.width; x += fine) {
            const auto at = [&](double dx, double dy) {
                return seen(panels, camera.from, camera.direction(x + dx, y + dy));
            };
            const std::size_t panel = at(0.5, 0.5).panel;
            bool on_one = true;
            for (const double dx : {0.0, 1.0}) {
                for (const double dy : {0.0, 1.0}) on_one &= at(dx, dy).panel == panel;
            }
            if (!on_one) continue;
            const double sign = panels[panel].plane_m == 0.0 ? 1.0 : -1.0;
            const Vec3 normal = sign * Vec3::Unit(panels[panel].axis);
            const auto mean = [&](const truth::RoomRadiosity& room) {
                double sum = 0.0;
                for (std::size_t i = 0; i < 3; ++i) {
                    for (std::size_t j = 0; j < 3; ++j) {
                        sum += weights[i] * weights[j] *
                               room.luminance(panel, at(nodes[i], nodes[j]).point, normal);
                    }
                }
                return sum;
            };
            const double truth = extrapolated(coarse, finer, mean);
            checks.push_back(pixel_check(camera, x, y, truth, near_edges_error * truth));
        }
    }
    return {fine == 1 ? "pixels/box" : "pixels/box-fine",
            fine == 1 ? "the box of closed_box/grey seen from within"
                      : "the same box in an image of 280 x 200 pixels, one in 20 along each axis",
            "radiosity as in closed_box, over each pixel that sees one wall by Gauss-Legendre "
            "quadrature",
            scene.parts,
            by_default(phases),
            checks};
}

Case block() {
    constexpr double emitted = 100.0, rho = 0.6;
    SceneBuilder scene;
    for (const optics::Shape& wall : SceneBuilder::room(1.0, 1.3, 0.8)) {
        scene.area_light(scene.object("wall", wall, scene.diffuse(rho)), emitted);
    }
    Placement placement = Placement::Identity();
    placement.translate(Vec3(0.45, 0.7, 0.0));
    placement.rotate(Eigen::AngleAxisd(0.5, Vec3::UnitZ()));
    scene.area_light(
        scene.object("block", optics::Box{placement, {0.3, 0.3, 0.3}}, scene.diffuse(rho)),
        emitted);
    const Pinhole camera{{0.5, 0.1, 0.6}, {0.5, 0.75, 0.05}, Vec3::UnitZ(), 0.7};
    camera.add_to(scene);
    const double truth = emitted / (1.0 - rho);
    std::vector<Check> checks;
    for (int y = 0; y < camera.height; ++y) {
        for (int x = 0; x < camera.width; ++x) {
            checks.push_back(pixel_check(camera, x, y, truth, 0.0));
        }
    }
    return {"pixels/block",
            "a luminous block on the floor of a luminous room, all of one reflectance",
            "furnace: L = Le / (1 - rho) on all surfaces",
            scene.parts,
            by_default(160),
            checks};
}

}  // namespace

std::vector<Case> pixel_cases() {
    return {box(1, 256), box(20, 64), block()};
}

}  // namespace lucerna::validation
