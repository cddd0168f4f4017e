// Samplers of lights against their densities: emission by place and direction, illumination by
// direction.
#include "light_checks.h"
#include "optics/geometry/ray_caster.h"
#include "optics/light/light.h"
#include "optics/light/opening.h"
#include "tests/support/direction_cells.h"

using namespace lucerna;
using namespace lucerna::optics;
using namespace lucerna::test;

namespace {

Placement turned() {
    Placement placement = Placement::Identity();
    placement.translate(Vec3(0.4, -0.3, 2.0));
    placement.rotate(Eigen::AngleAxisd(0.7, Vec3(1, 2, -1).normalized()));
    return placement;
}

/// A light on a shape that three planes through a centre cut into parts of equal area.
struct Symmetric {
    const char* name;
    AreaLight light;
    Vec3 centre;
    Eigen::Matrix3d axes;  ///< rows: normals of the planes
    int parts;             ///< 4 for flat shapes, which lie in the third plane, else 8
};

std::vector<Symmetric> symmetric_lights() {
    const Placement at = turned();
    const Eigen::Matrix3d axes = at.linear().transpose();
    const Vec3 x = at.linear().col(0), y = at.linear().col(1), z = at.linear().col(2);
    const Vec3 o = at.translation();
    const Rectangle rectangle{o, 0.7 * x, 1.1 * y};
    const Vec3 middle = o + 0.35 * x + 0.55 * y;
    return {{"rectangle", {0, rectangle}, middle, axes, 4},
            {"sheet", {0, rectangle, true}, middle, axes, 4},
            {"annulus", {0, Disk{o, z, 0.5, 0.2}}, o, axes, 4},
            {"sphere", {0, Sphere{o, 0.3}}, o, axes, 8},
            {"inner sphere", {0, Sphere{o, 0.3}, false, true}, o, axes, 8},
            {"cylinder", {0, Cylinder{o - 0.4 * z, o + 0.4 * z, 0.2}}, o, axes, 8},
            {"tube", {0, Tube{o - 0.4 * z, o + 0.4 * z, 0.3, 0.2}}, o, axes, 8},
            {"box", {0, Box{at, {0.3, 0.5, 0.2}}}, at * Vec3(0.15, 0.25, 0.1), axes, 8}};
}

constexpr int sines = 6, azimuths = 8;

/// Counts of emitted rays by part of the surface, side, sin^2 of the polar angle, and azimuth.
template <typename Emit>
std::vector<double> emission_counts(const Symmetric& of, std::uint32_t n, Emit emit_ray) {
    std::vector<double> counts(static_cast<std::size_t>(of.parts * 2 * sines * azimuths));
    const Vec3 across = Vec3(1, 2, 3).normalized();
    for (std::uint32_t i = 0; i < n; ++i) {
        const EmittedRay ray = emit_ray(uniforms(i));
        const Vec3 place = of.axes * (ray.surface.position - of.centre);
        int part = (place.x() > 0.0 ? 1 : 0) + (place.y() > 0.0 ? 2 : 0);
        if (of.parts == 8) part += place.z() > 0.0 ? 4 : 0;
        const Vec3& normal = ray.surface.normal;
        const double cosine = normal.dot(ray.ray.direction);
        const Vec3 e1 = normal.cross(across).normalized();
        const double turns =
            std::atan2(normal.cross(e1).dot(ray.ray.direction), e1.dot(ray.ray.direction)) /
            (2.0 * pi);
        const int side = cosine > 0.0 ? 0 : 1;
        const int s = std::min(sines - 1, static_cast<int>((1.0 - cosine * cosine) * sines));
        const int a = std::min(azimuths - 1, static_cast<int>((turns + 0.5) * azimuths));
        counts[static_cast<std::size_t>(((part * 2 + side) * sines + s) * azimuths + a)] += 1.0;
    }
    return counts;
}

/// The cosine law makes sin^2 uniform; without the cosine, cos itself is.
std::vector<double> emission_expected(const Symmetric& of, double n, bool cosine_law) {
    std::vector<double> expected;
    for (int part = 0; part < of.parts; ++part) {
        for (const bool front : {true, false}) {
            const double side = of.light.both_sides ? 0.5 : (front != of.light.inward ? 1.0 : 0.0);
            for (int s = 0; s < sines; ++s) {
                const double low = static_cast<double>(s) / sines, high = (s + 1.0) / sines;
                const double polar =
                    cosine_law ? high - low : std::sqrt(1.0 - low) - std::sqrt(1.0 - high);
                expected.insert(expected.end(), azimuths, n * side * polar / of.parts / azimuths);
            }
        }
    }
    return expected;
}

Luminaire luminaire(const Opening& opening) {
    Luminaire light;
    light.object = 0;
    light.position = turned().translation();
    light.to_photometric = turned().linear().transpose();
    light.intensity = std::make_shared<const IntensityDistribution>(
        std::vector<double>{0, 120, 240, 360}, std::vector<double>{0, 60, 120, 180},
        std::vector<std::vector<double>>{
            {90, 120, 30, 20}, {90, 40, 10, 20}, {90, 60, 50, 20}, {90, 120, 30, 20}});
    const Mesh mesh = *opening_mesh(opening);
    light.opening = MeshInstance{prepare_mesh(mesh.vertices, mesh.triangles), turned()};
    return light;
}

/// The largest angle from `axis` under which x sees a corner of the box; pi from within.
double half_angle_rad(const Eigen::AlignedBox3d& box, const Vec3& x, const Vec3& axis) {
    if (box.contains(x)) return pi;
    double half_angle = 0.0;
    for (int i = 0; i < 8; ++i) {
        const auto corner = static_cast<Eigen::AlignedBox3d::CornerType>(i);
        half_angle =
            std::max(half_angle, std::acos(axis.dot((box.corner(corner) - x).normalized())));
    }
    return std::min(pi, 1.01 * half_angle);
}

struct Illuminated {
    const char* name;
    LightSource light;
    Vec3 x;
};

std::vector<Illuminated> illuminated() {
    const Placement at = turned();
    const Vec3 o = at.translation();
    const Vec3 x = at.linear().col(0), y = at.linear().col(1), z = at.linear().col(2);
    const Rectangle rectangle{o, 0.7 * x, 1.1 * y};
    const Vec3 near = o + 0.5 * x - 0.4 * y + 0.6 * z;
    using Kind = Opening::Kind;
    return {
        {"rectangle", AreaLight{0, rectangle}, near},
        {"sheet from behind", AreaLight{0, rectangle, true}, o - 0.5 * z},
        {"annulus", AreaLight{0, Disk{o, z, 0.5, 0.2}}, near},
        {"sphere", AreaLight{0, Sphere{o, 0.3}}, near},
        {"inner sphere", AreaLight{0, Sphere{o, 0.6}, false, true}, o + 0.3 * x},
        {"cylinder", AreaLight{0, Cylinder{o - 0.4 * z, o + 0.4 * z, 0.2}}, near},
        {"box", AreaLight{0, Box{at, {0.3, 0.5, 0.2}}}, near},
        {"flat opening", luminaire({Kind::rectangle, {0.3, 1.2, 0.0}}), near},
        {"box opening",
         luminaire({Kind::box, {0.3, 1.2, 0.1}, Opening::Axis::z, {0.1, 0.1, 0.1, 0.1}}), near},
        {"cylindric opening", luminaire({Kind::cylinder, {0.3, 0.3, 0.4}}), o + 0.5 * x - 0.7 * z}};
}

const Shape& shape_of(const LightSource& light) {
    if (const auto* area = std::get_if<AreaLight>(&light)) return area->shape;
    return std::get<Luminaire>(light).opening;
}

}  // namespace

TEST_CASE("Area lights emit from all of their surface by the cosine", "[light][statistical]") {
    constexpr std::uint32_t n = 60000;
    for (const Symmetric& of : symmetric_lights()) {
        INFO(of.name);
        const auto counts = emission_counts(
            of, n, [&](const auto& u) { return emit(of.light, u[0], u[1], u[2], u[3]); });
        const auto expected = emission_expected(of, n, true);
        check_follows(counts, expected);
        // Twins: emission that is alike in all directions, and one whose direction hangs on the
        // place.
        check_refutes(counts, expected, emission_expected(of, n, false));
        const auto tied = emission_counts(
            of, n, [&](const auto& u) { return emit(of.light, u[0], u[1], u[0], u[1]); });
        CHECK(chi_square_deviate(tied, expected) > chi_square_limit);
    }
}

TEST_CASE("Lights are sampled as the density of illumination says", "[light][statistical]") {
    // The density toward a direction is that of the point that a ray from x meets there. All of
    // these lights are convex: what does not face x emits nothing toward it and is not counted.
    constexpr int n = 40'000;
    for (const Illuminated& of : illuminated()) {
        INFO(of.name);
        const Shape& shape = shape_of(of.light);
        const RayCaster caster(std::vector<Shape>{shape});
        const Eigen::AlignedBox3d box = bounds(shape);
        DirectionCells cells{.theta_cells = 8, .phi_cells = 12};
        // Past the centre, so that no outline runs along the edges of cells.
        if (!box.contains(of.x)) {
            cells.axis = (box.center() + 0.1 * box.sizes() - of.x).normalized();
        }
        cells.half_angle_rad = half_angle_rad(box, of.x, cells.axis);
        const Density density = [&](const Vec3& w) {
            const auto hit = caster.intersect({of.x, w}, nullptr);
            return hit ? illuminate_pdf_solid_angle(of.light, of.x, hit->point) : 0.0;
        };
        // The twin: the same density per area, as if it were one per solid angle.
        const Density per_area = [&](const Vec3& w) {
            const auto hit = caster.intersect({of.x, w}, nullptr);
            if (!hit) return 0.0;
            return illuminate_pdf_solid_angle(of.light, of.x, hit->point) *
                   std::abs(w.dot(hit->point.normal)) / std::pow(hit->distance_m, 2);
        };
        const auto counts = cells.counts(
            [&](double u1, double u2, double) -> std::optional<Vec3> {
                const auto sample = illuminate(of.light, of.x, u1, u2);
                return sample ? std::optional(sample->direction) : std::nullopt;
            },
            n);
        const auto expected = cells.expected(density, n, 16);
        check_follows(counts, expected);
        check_refutes(counts, expected, cells.expected(per_area, n, 2));
    }
}
