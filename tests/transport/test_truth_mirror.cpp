// Image sources: a plane mirror of reflectance 0.9 adds 0.9 of the light of the mirrored source.
#include "tests/support/truth_checks.h"
#include "validation/truth/polygon_light.h"
#include "validation/truth/quadrature.h"

using namespace lucerna;
using namespace lucerna::optics;
using validation::SceneBuilder;

namespace {

constexpr double mirror_x_m = 1.5;
constexpr double mirror_rho = 0.9;
constexpr double floor_rho = 0.5;

Vec3 mirrored(const Vec3& p) {
    return {2.0 * mirror_x_m - p.x(), p.y(), p.z()};
}

// Where the means are taken: [0.6, 1.4] x [-0.4, 0.4] on the floor.
const Vec3 middle(1.0, 0.0, 0.0);
constexpr double half_width_m = 0.4;

std::vector<Vec3> grid() {
    std::vector<Vec3> points;
    for (int i = 0; i < 8; ++i) {
        for (int j = 0; j < 8; ++j) {
            points.push_back(middle + half_width_m * Vec3((i - 3.5) / 4.0, (j - 3.5) / 4.0, 0.0));
        }
    }
    return points;
}

// A floor that reflects is seen by a camera from above, row 0 of the run; a black one carries
// sensors. Light that the floor reflects goes up, also by way of the mirror, and never returns.
SceneBuilder with_mirror(bool camera) {
    SceneBuilder scene;
    scene.object("mirror", Rectangle{{mirror_x_m, -4, 0}, {0, 0, 4}, {0, 8, 0}},
                 scene.mirror(mirror_rho));
    scene.object("floor", Rectangle{{-3, -3, 0}, {4.5, 0, 0}, {0, 6, 0}},
                 camera ? scene.diffuse(floor_rho) : scene.black());
    if (camera) {
        const double height_m = 3.0;
        scene.camera(middle + height_m * Vec3::UnitZ(), middle, Vec3::UnitY(),
                     2.0 * std::atan(half_width_m / height_m), 24, 24);
    } else {
        scene.points(grid(), Vec3::UnitZ());
    }
    return scene;
}

// Mean over the grid of sensors, or over the image.
std::vector<test::Replicates::Value> read_mean(const Result& result) {
    if (!result.images.empty()) return {test::mean_of_image(result.images.front())};
    return {test::mean_of_sensors(result)};
}

// The same mean of a function of the place on the floor.
template <typename Illuminance>
double mean(bool camera, const Illuminance& illuminance) {
    if (!camera) {
        double sum = 0.0;
        for (const Vec3& x : grid()) sum += illuminance(x) / static_cast<double>(grid().size());
        return sum;
    }
    const double integral = truth::integral(
        [&](double s) {
            return truth::integral([&](double t) { return illuminance(middle + Vec3(s, t, 0.0)); },
                                   -half_width_m, half_width_m, 2);
        },
        -half_width_m, half_width_m, 2);
    return floor_rho / pi * integral / (4.0 * half_width_m * half_width_m);
}

}  // namespace

TEST_CASE("Image source: a point light before a mirror", "[analytic]") {
    const bool camera = GENERATE(false, true);
    const auto method = GENERATE(Method::combined, Method::forward, Method::backward);
    if (!camera && method == Method::backward) return;  // sensors are read as in combined
    const Vec3 lamp(1.0, 0.0, 1.0);
    const double intensity = 100.0;
    SceneBuilder scene = with_mirror(camera);
    scene.light("lamp", PointLight{lamp}, 4.0 * pi * intensity);
    const auto from = [&](const Vec3& source) {
        return [&, source](const Vec3& x) {
            return intensity * source.z() / std::pow((source - x).norm(), 3);
        };
    };
    const double direct = mean(camera, from(lamp));
    const double image = mean(camera, from(mirrored(lamp)));
    INFO("camera " << camera << " method " << static_cast<int>(method));
    const auto runs = test::over_batches(
        scene, method, {method == Method::backward ? 8u : 2u, 50000}, 10, read_mean);
    test::check_truth_over_runs(runs[0], direct + mirror_rho * image);
    test::check_refutes_over_runs(runs[0], direct + image);
}

TEST_CASE("Image source: a rectangle before a mirror", "[analytic]") {
    const bool camera = GENERATE(false, true);
    const auto method = GENERATE(Method::combined, Method::backward, Method::path);
    if (!camera && method == Method::backward) return;  // sensors are read as in combined
    const double luminance = 1000.0;
    const Vec3 corner(0.3, -0.2, 1.0);  // beside the camera's view
    const Vec3 u(0.0, 0.4, 0.0);
    const Vec3 v(0.3, 0.0, 0.0);
    SceneBuilder scene = with_mirror(camera);
    scene.area_light(scene.object("lamp", Rectangle{corner, u, v}, scene.black()), luminance);
    const auto polygon = truth::corners(corner, u, v);
    std::vector<Vec3> image_polygon;
    for (const Vec3& p : polygon) image_polygon.push_back(mirrored(p));
    const auto from = [&](const std::vector<Vec3>& source) {
        return [&](const Vec3& x) {
            return truth::polygon_illuminance(source, luminance, x, Vec3::UnitZ());
        };
    };
    const double direct = mean(camera, from(polygon));
    const double image = mean(camera, from(image_polygon));
    INFO("camera " << camera << " method " << static_cast<int>(method));
    const test::Effort effort = method == Method::path
                                    ? test::Effort{40, 100, 16}
                                    : test::Effort{method == Method::backward ? 5u : 2u, 40000, 16};
    const auto runs = test::over_batches(scene, method, effort, 10, read_mean);
    test::check_truth_over_runs(runs[0], direct + mirror_rho * image);
    test::check_refutes_over_runs(runs[0], direct);
}
