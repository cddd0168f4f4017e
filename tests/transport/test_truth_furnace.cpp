// Closed furnaces: where every surface emits L_e and reflects rho, L = L_e + rho L in a uniform
// field, so that L = L_e / (1 - rho) everywhere in air, whatever the shapes.
#include "tests/support/mesh_shapes.h"
#include "tests/support/truth_checks.h"

using namespace lucerna;
using namespace lucerna::optics;
using validation::SceneBuilder;

namespace {

constexpr double emitted = 100.0;  // cd/m2

// Runs the furnace and looks with all its observers; `rho` is that of all walls.
void check_furnace(const SceneBuilder& scene, double rho, Method method,
                   const test::Effort& effort) {
    const double truth = emitted / (1.0 - rho);
    INFO("rho " << rho << " method " << static_cast<int>(method));
    for (const Quantity& quantity : test::run(scene, method, effort).quantities) {
        INFO(quantity.quantity << " " << quantity.name);
        const double value = quantity.quantity == "illuminance" ? pi * truth : truth;
        test::check_truth(quantity.estimate, value);
        // Emission and one reflection only.
        test::check_refutes(quantity.estimate, value * (1.0 + rho) * (1.0 - rho));
    }
}

SceneBuilder shell(const Shape& shape, double rho) {
    SceneBuilder scene;
    scene.area_light(scene.object("shell", shape, scene.diffuse(rho)), emitted, true);
    return scene;
}

Placement turned() {
    Placement placement = Placement::Identity();
    placement.rotate(Eigen::AngleAxisd(0.7, Vec3(1.0, 2.0, -0.5).normalized()));
    return placement;
}

}  // namespace

TEST_CASE("Furnace: a box room", "[analytic]") {
    const auto [rho, effort] = GENERATE(
        table<double, test::Effort>({{0.2, {32, 1000}}, {0.5, {72, 2500}}, {0.9, {104, 6000}}}));
    const auto method = GENERATE(Method::combined, Method::forward, Method::backward, Method::path);
    // Without specular surfaces the backward method is the combined one.
    if (method == Method::backward && rho != 0.5) return;
    // A map gathered where it is seen needs many kernels in view.
    const double half_angle_rad = method == Method::forward ? 1.0 : 0.4;
    SceneBuilder scene;
    for (const Shape& wall : SceneBuilder::room(1.0, 1.3, 0.8)) {
        scene.area_light(scene.object("wall", wall, scene.diffuse(rho)), emitted);
    }
    scene.meter({0.5, 0.6, 0.4}, {0.2, 0.0, 0.1}, half_angle_rad);
    scene.meter({0.5, 0.6, 0.4}, {0.0, 0.0, 0.0}, half_angle_rad);  // a corner
    // A photon map at a single point is noisy; see the next case.
    if (method != Method::forward) {
        scene.points({{0.3, 0.5, 0.3}}, Vec3(1.0, 2.0, 3.0).normalized());
    }
    // Single paths need few of them, each of which costs more.
    test::Effort own = effort;
    if (method == Method::path) own.phases = rho == 0.9 ? 66 : effort.phases / 2;
    // A split path takes as long as three whole ones.
    if (method == Method::forward) own.forward_rays /= 3;
    check_furnace(scene, rho, method, own);
}

TEST_CASE("Furnace: illuminance by photons that cross sensor planes", "[analytic]") {
    const double rho = 0.7;
    SceneBuilder scene = shell(Sphere{Vec3::Zero(), 1.0}, rho);
    std::vector<Vec3> positions;
    for (int i = -4; i <= 4; ++i) {
        for (int j = -4; j <= 4; ++j) positions.emplace_back(0.11 * i, 0.11 * j, 0.1);
    }
    scene.points(positions, Vec3::UnitZ());
    const auto runs = test::over_batches(
        scene, Method::forward, {8, 10000}, 16,
        [](const Result& result) { return std::vector{test::mean_of_sensors(result)}; });
    test::check_truth_over_runs(runs[0], pi * emitted / (1.0 - rho));
    test::check_refutes_over_runs(runs[0], 0.97 * pi * emitted / (1.0 - rho));
}

TEST_CASE("Furnace: closed shapes seen from within", "[analytic]") {
    const double rho = 0.7;
    const double half_angle_rad = 0.5;
    SECTION("box") {
        SceneBuilder scene = shell(Box{turned(), {1.0, 1.3, 0.8}}, rho);
        const Vec3 middle = turned() * Vec3(0.5, 0.6, 0.4);
        scene.meter(middle, turned() * Vec3(1.0, 0.7, 0.3), half_angle_rad);
        scene.meter(middle, turned() * Vec3(1.0, 1.3, 0.8), half_angle_rad);
        check_furnace(scene, rho, Method::combined, {64, 6000});
    }
    SECTION("sphere") {
        SceneBuilder scene = shell(Sphere{{0.1, 0.2, 0.3}, 0.6}, rho);
        scene.meter({0.1, 0.2, 0.3}, {0.7, 0.2, 0.3}, half_angle_rad);
        scene.meter({0.5, 0.3, 0.1}, {0.1, 0.8, 0.3}, half_angle_rad);
        check_furnace(scene, rho, Method::combined, {64, 6000});
    }
    SECTION("cylinder") {
        SceneBuilder scene = shell(Cylinder{{0.0, 0.0, 0.0}, {0.4, 0.2, 1.0}, 0.4}, rho);
        scene.meter({0.2, 0.1, 0.5}, {0.6, 0.1, 0.5}, half_angle_rad);   // the side
        scene.meter({0.2, 0.1, 0.5}, {0.4, 0.2, 1.0}, half_angle_rad);   // a cap
        scene.meter({0.2, 0.1, 0.5}, {0.35, 0.0, 0.0}, half_angle_rad);  // the edge between both
        check_furnace(scene, rho, Method::combined, {64, 6000});
    }
    SECTION("between the walls of a tube") {
        SceneBuilder scene = shell(Tube{{0.0, 0.0, 0.0}, {0.0, 0.3, 0.7}, 0.6, 0.2}, rho);
        scene.meter({0.4, 0.15, 0.35}, {0.0, 0.15, 0.35}, half_angle_rad);  // the inner side
        scene.meter({0.4, 0.15, 0.35}, {0.4, 0.45, 0.35}, half_angle_rad);  // the outer side
        scene.meter({0.4, 0.15, 0.35}, {0.3, 0.3, 0.7}, half_angle_rad);    // an annulus
        check_furnace(scene, rho, Method::combined, {64, 6000});
    }
    SECTION("mesh of a box") {
        SceneBuilder scene = shell(MeshInstance{test::box_mesh({1.0, 1.3, 0.8}, 8), turned()}, rho);
        const Vec3 middle = turned() * Vec3(0.5, 0.6, 0.4);
        scene.meter(middle, turned() * Vec3(1.0, 0.7, 0.3), half_angle_rad);
        scene.meter(middle, turned() * Vec3(1.0, 1.3, 0.8), half_angle_rad);
        check_furnace(scene, rho, Method::combined, {64, 6000});
    }
    SECTION("mesh of a sphere") {
        SceneBuilder scene = shell(MeshInstance{test::sphere_mesh(0.6, 24), turned()}, rho);
        scene.meter({0.0, 0.0, 0.0}, {0.6, 0.2, 0.1}, half_angle_rad);
        scene.meter({0.3, 0.1, -0.1}, {0.1, 0.5, 0.3}, half_angle_rad);
        check_furnace(scene, rho, Method::combined, {64, 6000});
    }
}

TEST_CASE("Furnace: curved shapes by a map gathered where it is seen", "[analytic]") {
    const double rho = 0.7;
    const double half_angle_rad = 1.0;
    SECTION("cylinder") {
        SceneBuilder scene = shell(Cylinder{{0.0, 0.0, 0.0}, {0.4, 0.2, 1.0}, 0.4}, rho);
        scene.meter({0.2, 0.1, 0.5}, {0.35, 0.0, 0.0}, half_angle_rad);
        check_furnace(scene, rho, Method::forward, {64, 2000});
    }
    SECTION("between the walls of a tube") {
        SceneBuilder scene = shell(Tube{{0.0, 0.0, 0.0}, {0.0, 0.3, 0.7}, 0.6, 0.2}, rho);
        scene.meter({0.4, 0.15, 0.35}, {0.0, 0.15, 0.35}, half_angle_rad);
        check_furnace(scene, rho, Method::forward, {96, 2000});
    }
    SECTION("mesh of a sphere") {
        SceneBuilder scene = shell(MeshInstance{test::sphere_mesh(0.6, 24), turned()}, rho);
        scene.meter({0.3, 0.1, -0.1}, {0.1, 0.5, 0.3}, half_angle_rad);
        check_furnace(scene, rho, Method::forward, {48, 2000});
    }
}

TEST_CASE("Furnace: things of all shapes in a room", "[analytic]") {
    // What stands in a furnace and follows the same law does not disturb it.
    const double rho = 0.7;
    SceneBuilder scene;
    const BsdfId paint = scene.diffuse(rho);
    for (const Shape& wall : SceneBuilder::room(1.0, 1.0, 1.0)) {
        scene.area_light(scene.object("wall", wall, paint), emitted);
    }
    Placement aside = turned();
    aside.pretranslate(Vec3(0.70, 0.25, 0.25));
    scene.area_light(scene.object("sphere", Sphere{{0.25, 0.25, 0.25}, 0.12}, paint), emitted);
    scene.area_light(
        scene.object("cylinder", Cylinder{{0.2, 0.7, 0.2}, {0.3, 0.8, 0.3}, 0.1}, paint), emitted);
    scene.area_light(
        scene.object("tube", Tube{{0.7, 0.7, 0.15}, {0.75, 0.8, 0.4}, 0.12, 0.06}, paint), emitted);
    scene.area_light(scene.object("box", Box{aside, {0.15, 0.1, 0.2}}, paint), emitted);
    scene.area_light(
        scene.object("sheet", Disk{{0.3, 0.3, 0.7}, Vec3(1, 1, 1).normalized(), 0.15, 0.05}, paint),
        emitted, false, true);
    aside.pretranslate(Vec3(0.05, 0.1, 0.5));
    scene.area_light(
        scene.object("mesh", MeshInstance{test::box_mesh({0.15, 0.1, 0.2}, 4), aside}, paint),
        emitted);
    // A white sheet that lets half of the light through, and a perfect mirror: L = L.
    scene.object("paper", Rectangle{{0.1, 0.5, 0.5}, {0.2, 0.0, 0.0}, {0.0, 0.1, 0.2}},
                 scene.diffuse(0.5, 0.5));
    scene.object("mirror", Disk{{0.6, 0.6, 0.8}, Vec3(1, 2, -1).normalized(), 0.1},
                 scene.mirror(1.0));
    const Vec3 eye(0.5, 0.5, 0.5);
    for (const Vec3& thing :
         {Vec3(0.25, 0.25, 0.25), Vec3(0.25, 0.75, 0.25), Vec3(0.72, 0.75, 0.28),
          Vec3(0.3, 0.3, 0.7), Vec3(0.2, 0.55, 0.6), Vec3(0.6, 0.6, 0.8)}) {
        scene.meter(eye, thing, 0.15);
    }
    scene.meter(eye, aside * Vec3(0.07, 0.05, 0.1), 0.15);
    check_furnace(scene, rho, Method::combined, {90, 6000});
}

TEST_CASE("Furnace: a large image, where a ray gathers for others of its pixel", "[analytic]") {
    // 4 of 8 rays of a pixel gather, both behind a mirror and straight on; the rims of the two
    // balls are pixels with several surfaces.
    const double rho = 0.7;
    const int pixels = 128;
    SceneBuilder scene = shell(Sphere{Vec3::Zero(), 1.0}, rho);
    scene.area_light(
        scene.object("painted ball", Sphere{{0.3, 0.0, 0.0}, 0.25}, scene.diffuse(rho)), emitted);
    scene.object("mirror ball", Sphere{{-0.3, 0.0, 0.0}, 0.25}, scene.mirror(1.0));
    scene.camera({0.0, -0.9, 0.0}, Vec3::Zero(), Vec3::UnitZ(), 1.1, pixels, pixels);
    const Result result = test::run(scene, Method::forward, {6, 20000, 8});
    const double truth = emitted / (1.0 - rho);
    const Image& image = result.images.front();
    test::check_mean(image.mean.value(), image.mean.standard_error(), truth, {0.05});
    test::check_refutes(image.mean, 1.05 * truth);
    // What the other rays of a pixel leave out would be a third of the luminance. Each place by
    // itself: the mirror ball, the painted one, and the wall above them.
    const int tiles = pixels / Image::tile_size;
    for (const auto& [column, row] : {std::pair(2, 4), std::pair(5, 4), std::pair(4, 0)}) {
        INFO("tile " << column << ", " << row);
        const Estimate& tile = image.tiles[static_cast<std::size_t>(row * tiles + column)];
        test::check_mean(tile.value(), tile.standard_error(), truth, {0.25});
    }
}
