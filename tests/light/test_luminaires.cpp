// Luminaires: a measured intensity that leaves an opening of finite size.
#include "light_checks.h"
#include "optics/geometry/mesh.h"
#include "optics/light/light.h"
#include "optics/light/opening.h"

using namespace lucerna;
using namespace lucerna::optics;
using namespace lucerna::test;
using Catch::Matchers::WithinRel;

namespace {

constexpr ObjectId object = 3;

// Without symmetry, mostly downward, some of it up.
std::shared_ptr<const IntensityDistribution> skewed() {
    return std::make_shared<const IntensityDistribution>(
        std::vector<double>{0, 90, 180, 270, 360}, std::vector<double>{0, 45, 90, 135, 180},
        std::vector<std::vector<double>>{{90, 120, 30, 10, 20},
                                         {90, 80, 10, 5, 20},
                                         {90, 40, 20, 30, 20},
                                         {90, 60, 50, 20, 20},
                                         {90, 120, 30, 10, 20}});
}

std::shared_ptr<const IntensityDistribution> cosine() {
    std::vector<double> gamma;
    std::vector<double> values;
    for (int i = 0; i <= 900; ++i) {
        gamma.push_back(0.1 * i);
        values.push_back(std::max(0.0, std::cos(gamma.back() * pi / 180.0)));
    }
    values.back() = 0.0;
    return std::make_shared<const IntensityDistribution>(std::vector<double>{0}, gamma,
                                                         std::vector<std::vector<double>>{values});
}

// Placed and turned in the scene, to find a rotation that is applied the wrong way round.
Placement turned_luminaire() {
    Placement placement = Placement::Identity();
    placement.translate(Vec3(1, 2, 3));
    placement.rotate(Eigen::AngleAxisd(0.7, Vec3(1, 2, -1).normalized()));
    return placement;
}

Luminaire luminaire(const Opening& opening,
                    std::shared_ptr<const IntensityDistribution> intensity) {
    Luminaire light;
    light.position = turned_luminaire().translation();
    light.to_photometric = turned_luminaire().linear().transpose();
    light.intensity = std::move(intensity);
    if (auto mesh = opening_mesh(opening)) {
        light.object = object;
        light.opening =
            MeshInstance{prepare_mesh(mesh->vertices, mesh->triangles), turned_luminaire()};
    }
    return light;
}

Opening box() {
    return {Opening::Kind::box, {0.3, 1.2, 0.1}, Opening::Axis::z, {0.1, 0.1, 0.1, 0.1}};
}

// Projected area of that box in the photometric frame, from its edges.
double box_area_m2(const Vec3& w) {
    return 0.3 * 1.2 * std::abs(w.z()) + 1.2 * 0.1 * std::abs(w.x()) + 0.3 * 0.1 * std::abs(w.y());
}

}  // namespace

TEST_CASE("Radiance of a luminaire is intensity by projected area", "[light][analytic]") {
    const Luminaire light = luminaire(box(), skewed());
    for (std::uint32_t i = 0; i < 100; ++i) {
        const auto u = uniforms(i);
        const Vec3 local = Vec3(u[0] - 0.5, u[1] - 0.5, u[2] - 0.5).normalized();
        const Vec3 w = turned_luminaire().linear() * local;
        const SurfacePoint seen = light.opening.faces().sample_toward(w, u[3], 0.4);
        const double truth = light.intensity->intensity_cd(local) /
                             light.intensity->luminous_flux_lm() / box_area_m2(local);
        CHECK_THAT(radiance_factor(light, seen, w), WithinRel(truth, 1e-9));
        CHECK(radiance_factor(light, seen, -w) == 0.0);
    }
    // A sheet: I / (A cos), on both sides.
    const Luminaire sheet = luminaire({Opening::Kind::rectangle, {0.3, 1.2, 0.0}}, skewed());
    const SurfacePoint point = sheet.opening.faces().sample_toward(Vec3::UnitX(), 0.5, 0.5);
    for (const double z : {-0.8, 0.8}) {
        const Vec3 local(0.6, 0.0, z);
        const double truth = sheet.intensity->intensity_cd(local) /
                             sheet.intensity->luminous_flux_lm() / (0.36 * 0.8);
        CHECK_THAT(radiance_factor(sheet, point, turned_luminaire().linear() * local),
                   WithinRel(truth, 1e-9));
    }
}

TEST_CASE("A luminaire emits its intensity, whatever its opening", "[light][statistical]") {
    const std::vector<Opening> openings = {
        {},
        {Opening::Kind::rectangle, {0.3, 1.2, 0.0}},
        box(),
        {Opening::Kind::cylinder, {0.3, 0.3, 0.2}},
        {Opening::Kind::ellipsoid, {0.3, 0.4, 0.5}},
        {Opening::Kind::box, {0.3, 1.2, 0.1}, Opening::Axis::z, {0.1, 0.0, 0.05, 0.0}}};
    for (const Opening& opening : openings) {
        const Luminaire light = luminaire(opening, skewed());
        constexpr int columns = 24;
        constexpr int rows = 18;
        constexpr std::uint32_t n = 200000;
        std::vector<double> counts(columns * rows);
        bool weights_are_one = true;
        bool emits_there = true;
        for (std::uint32_t i = 0; i < n; ++i) {
            const auto u = uniforms(i);
            const EmittedRay ray = emit(light, u[0], u[1], u[2], u[3]);
            weights_are_one = weights_are_one && ray.weight == 1.0;
            if (light.object == object) {
                emits_there = emits_there && ray.surface.object == object &&
                              radiance_factor(light, ray.surface, ray.ray.direction) > 0.0;
            }
            const Vec3 w = light.to_photometric * ray.ray.direction;
            double c = std::atan2(w.y(), w.x()) / (2.0 * pi);
            if (c < 0.0) c += 1.0;
            const int column = std::min(columns - 1, static_cast<int>(c * columns));
            const int row = std::min(rows - 1, static_cast<int>(std::acos(-w.z()) / pi * rows));
            counts[static_cast<std::size_t>(row * columns + column)] += 1.0;
        }
        // Expected by midpoints of the intensity, 10 x 10 per bin.
        std::vector<double> expected(columns * rows);
        for (int bin = 0; bin < columns * rows; ++bin) {
            double sum = 0.0;
            for (int i = 0; i < 100; ++i) {
                const double c = (bin % columns + (i % 10 + 0.5) / 10) * 360.0 / columns;
                const double gamma = (bin / columns + (i / 10 + 0.5) / 10) * 180.0 / rows;
                sum += light.intensity->intensity_cd(IntensityDistribution::direction(c, gamma)) *
                       std::sin(gamma * pi / 180.0);
            }
            const double cell = 2.0 * pi / columns * pi / rows / 100.0;
            expected[static_cast<std::size_t>(bin)] =
                n * sum * cell / light.intensity->luminous_flux_lm();
        }
        CHECK(weights_are_one);
        CHECK(emits_there);
        check_follows(counts, expected);
    }
}

TEST_CASE("An opening emits toward each direction from all that is seen of it alike",
          "[light][statistical]") {
    // Cells of direction x face x quarter of the face. Where n.w > 0 a face has the share
    // n.w A / sum of n.w A of the rays toward w, uniform over the face; by midpoints.
    const Luminaire light = luminaire(box(), skewed());
    const std::array<Vec3, 6> normals = {-Vec3::UnitX(), Vec3::UnitX(),  -Vec3::UnitY(),
                                         Vec3::UnitY(),  -Vec3::UnitZ(), Vec3::UnitZ()};
    const std::array<double, 6> areas = {0.12, 0.12, 0.03, 0.03, 0.36, 0.36};
    constexpr std::size_t rows = 6, columns = 8, quarters = 4;
    constexpr std::uint32_t n = 200000;
    const auto cell = [](std::size_t row, std::size_t column, std::size_t face) {
        return ((row * columns + column) * 6 + face) * quarters;
    };
    std::vector<double> expected(rows * columns * 6 * quarters), by_area = expected,
                                                                 counts = expected;
    constexpr std::size_t fine = 50;  // midpoints per cell and angle
    for (std::size_t i = 0; i < rows * fine; ++i) {
        for (std::size_t j = 0; j < columns * fine; ++j) {
            const double gamma = (static_cast<double>(i) + 0.5) * 180.0 / (rows * fine);
            const double c = (static_cast<double>(j) + 0.5) * 360.0 / (columns * fine);
            const Vec3 w = IntensityDistribution::direction(c, gamma);
            const double rays = n * light.intensity->pdf_solid_angle(w) *
                                std::sin(gamma * pi / 180.0) * 2.0 * pi * pi /
                                (rows * columns * fine * fine);
            double seen_m2 = 0.0;
            for (std::size_t f = 0; f < 6; ++f) seen_m2 += normals[f].dot(w) > 0.0 ? areas[f] : 0.0;
            for (std::size_t f = 0; f < 6; ++f) {
                const double cosine = std::max(0.0, normals[f].dot(w));
                for (std::size_t quarter = 0; quarter < quarters; ++quarter) {
                    const std::size_t k = cell(i / fine, j / fine, f) + quarter;
                    expected[k] += rays * cosine * areas[f] / box_area_m2(w) / quarters;
                    by_area[k] += rays * (cosine > 0.0 ? areas[f] : 0.0) / seen_m2 / quarters;
                }
            }
        }
    }
    for (std::uint32_t i = 0; i < n; ++i) {
        const auto u = uniforms(i);
        const EmittedRay ray = emit(light, u[0], u[1], u[2], u[3]);
        const Vec3 w = light.to_photometric * ray.ray.direction;
        const Vec3 normal = light.to_photometric * ray.surface.normal;
        const Vec3 place = turned_luminaire().inverse() * ray.surface.position;
        std::size_t face = 0;
        for (std::size_t f = 0; f < 6; ++f) face = normals[f].dot(normal) > 0.99 ? f : face;
        REQUIRE_THAT(
            normals[face].dot(place - 0.5 * Vec3(0.3, 1.2, 0.1).cwiseProduct(normals[face])),
            Catch::Matchers::WithinAbs(0.0, 1e-9));
        const auto axis = static_cast<Eigen::Index>(face / 2);
        const std::size_t quarter =
            (place[(axis + 1) % 3] > 0.0 ? 1u : 0u) + (place[(axis + 2) % 3] > 0.0 ? 2u : 0u);
        const double turns = std::atan2(w.y(), w.x()) / (2.0 * pi);
        const auto column = std::min(
            columns - 1, static_cast<std::size_t>((turns < 0.0 ? turns + 1.0 : turns) * columns));
        const auto row =
            std::min(rows - 1, static_cast<std::size_t>(std::acos(-w.z()) / pi * rows));
        counts[cell(row, column, face) + quarter] += 1.0;
    }
    check_follows(counts, expected);
    check_refutes(counts, expected, by_area);  // the twin: by area instead of projected area
}

TEST_CASE("Far away a luminaire illuminates as its intensity by the square of the distance",
          "[light][analytic]") {
    for (const Opening& opening : {Opening{}, Opening{Opening::Kind::rectangle, {0.3, 1.2, 0.0}},
                                   box(), Opening{Opening::Kind::cylinder, {0.3, 0.3, 0.2}},
                                   Opening{Opening::Kind::ellipsoid, {0.3, 0.4, 0.5}}}) {
        const Luminaire light = luminaire(opening, skewed());
        for (const Vec3& direction : {Vec3(0.3, 0.2, -1), Vec3(1, 0.5, -0.3), Vec3(-1, 1, 2)}) {
            const Vec3 local = direction.normalized();
            const double distance = 1000.0;
            const Vec3 x = light.position + distance * (turned_luminaire().linear() * local);
            const Mean mean = mean_of(20000, [&](const auto& u) {
                const auto sample = illuminate(light, x, u[0], u[1]);
                return sample ? sample->factor : 0.0;
            });
            const double truth = light.intensity->pdf_solid_angle(local) / (distance * distance);
            // The extent of 1 m against 1000 m, and the slope of the interpolant.
            CHECK(std::abs(mean.value / truth - 1.0) <
                  2e-3 + level_1e6 * mean.standard_error / truth);
        }
    }
}

TEST_CASE("A luminaire with a cosine distribution illuminates as a Lambertian rectangle",
          "[light][analytic]") {
    const Luminaire light = luminaire({Opening::Kind::rectangle, {0.6, 1.2, 0.0}}, cosine());
    const Rectangle shape{{-0.3, -0.6, 0.0}, {0.0, 1.2, 0.0}, {0.6, 0.0, 0.0}};
    const AreaLight lambertian{object, shape};
    for (const Vec3& x : {Vec3(0, 0, -0.5), Vec3(1, 0.4, -0.7)}) {
        const auto lambert = mean_of(100000, [&](const auto& u) {
            const auto sample = illuminate(lambertian, x, u[0], u[1]);
            return sample->factor * std::abs(sample->direction.z());
        });
        const auto measured = mean_of(100000, [&](const auto& u) {
            const auto sample = illuminate(light, turned_luminaire() * x, u[0], u[1]);
            return sample->factor * std::abs((light.to_photometric * sample->direction).z());
        });
        // The same integrand but for the interpolation of the cosine (4e-7) and independent points.
        check_mean(measured.value, std::hypot(measured.standard_error, lambert.standard_error),
                   lambert.value, {0.05}, 1e-5 * lambert.value);
    }
}

TEST_CASE("Illumination by a luminaire integrates its radiance near by", "[light][analytic]") {
    // E of the box at a near point by midpoints over its faces, against the sampled mean.
    const Luminaire light = luminaire(box(), skewed());
    for (const Vec3& local_x : {Vec3(0.3, 0.2, -0.4), Vec3(0.8, -1.0, 0.3)}) {
        const Vec3 half(0.15, 0.6, 0.05);
        double truth = 0.0;
        for (int axis = 0; axis < 3; ++axis) {
            const int a = (axis + 1) % 3;
            const int b = (axis + 2) % 3;
            for (const double sign : {-1.0, 1.0}) {
                constexpr int steps = 300;
                const double patch = 4.0 * half[a] * half[b] / (steps * steps);
                for (int i = 0; i < steps * steps; ++i) {
                    Vec3 p;
                    p[axis] = sign * half[axis];
                    p[a] = (2.0 * (i % steps + 0.5) / steps - 1.0) * half[a];
                    p[b] = (2.0 * (i / steps + 0.5) / steps - 1.0) * half[b];
                    const Vec3 to_x = local_x - p;
                    const Vec3 w = to_x.normalized();
                    const double cosine = sign * w[axis];
                    if (cosine <= 0.0) continue;
                    truth += light.intensity->pdf_solid_angle(w) / box_area_m2(w) * cosine * patch /
                             to_x.squaredNorm();
                }
            }
        }
        const Vec3 x = turned_luminaire() * local_x;
        const Mean mean = mean_of(400000, [&](const auto& u) {
            const auto sample = illuminate(light, x, u[0], u[1]);
            return sample ? sample->factor : 0.0;
        });
        check_mean(mean.value, mean.standard_error, truth, {0.02}, 2e-4 * truth);
    }
}

TEST_CASE("Density, factor and radiance of a luminaire's illumination fit together",
          "[light][property]") {
    for (const Opening& opening : {Opening{Opening::Kind::rectangle, {0.3, 1.2, 0.0}}, box(),
                                   Opening{Opening::Kind::ellipsoid, {0.3, 0.4, 0.5}}}) {
        const Luminaire light = luminaire(opening, skewed());
        for (std::uint32_t i = 0; i < 200; ++i) {
            const auto u = uniforms(i);
            const Vec3 x = light.position + 4.0 * Vec3(u[2] - 0.5, u[3] - 0.5, u[0] - 0.5);
            const auto sample = illuminate(light, x, u[0], u[1]);
            if (!sample) continue;
            CHECK_THAT(illuminate_pdf_solid_angle(light, x, sample->surface),
                       WithinRel(sample->pdf_solid_angle, 1e-9));
            CHECK_THAT(radiance_factor(light, sample->surface, -sample->direction),
                       WithinRel(sample->factor * sample->pdf_solid_angle, 1e-9));
            CHECK(sample->surface.object == object);
        }
    }
    CHECK(emitting_object(luminaire(box(), skewed())) == object);
    CHECK(emitting_object(luminaire({}, skewed())) == no_object);
    CHECK(illuminate(luminaire({}, skewed()), {0, 0, 0}, 0.5, 0.5)->delta);
}

TEST_CASE("Only rectangles and meshes are openings", "[light][unit]") {
    CHECK_THROWS_AS(LuminousOpening(Sphere{{0, 0, 0}, 1.0}), std::invalid_argument);
    CHECK_NOTHROW(LuminousOpening(Rectangle{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
}
