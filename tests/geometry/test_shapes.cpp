#include <catch2/catch.hpp>
#include <functional>

#include "optics/geometry/shape_parts.h"
#include "shapes_for_tests.h"
#include "tests/support/chi_square.h"

namespace lucerna::optics {

namespace {

using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

/// Distance of a point from the surface of an exact shape's patch, from its definition.
double off_surface(const Shape& shape, const SurfacePoint& p) {
    struct Measure {
        const SurfacePoint& p;
        double round(const Vec3& from, const Vec3& to, double radius) const {
            return std::abs((p.position - from).cross((to - from).normalized()).norm() - radius);
        }
        double flat(const Vec3& foot, const Vec3& normal) const {
            return std::abs((p.position - foot).dot(normal.normalized()));
        }
        double operator()(const Rectangle& s) const {
            return flat(s.corner, s.edge_u.cross(s.edge_v));
        }
        double operator()(const Box& s) const {
            const Vec3 q = s.placement.inverse() * p.position;
            const int axis = static_cast<int>(p.patch / 2);
            return std::abs(q[axis] - (p.patch % 2 ? s.size_m[axis] : 0.0));
        }
        double operator()(const Disk& s) const { return flat(s.centre, s.normal); }
        double operator()(const Sphere& s) const {
            return std::abs((p.position - s.centre).norm() - s.radius_m);
        }
        double operator()(const Cylinder& s) const {
            if (p.patch == 0) return round(s.from, s.to, s.radius_m);
            return flat(p.patch == 1 ? s.from : s.to, s.to - s.from);
        }
        double operator()(const Tube& s) const {
            if (p.patch == 0) return round(s.from, s.to, s.radius_m);
            if (p.patch == 1) return round(s.from, s.to, s.inner_radius_m);
            return flat(p.patch == 2 ? s.from : s.to, s.to - s.from);
        }
        double operator()(const MeshInstance& s) const {
            return flat(s.placement * s.mesh->vertices[s.mesh->triangles[p.primitive][0]],
                        p.normal);
        }
    };
    return std::visit(Measure{p}, shape);
}

SurfacePoint surface_point(const ShapeHit& hit) {
    return {hit.position, hit.normal, 0, hit.patch, hit.primitive};
}

double volume_m3(const Shape& shape) {
    if (const auto* s = std::get_if<Box>(&shape)) return s->size_m.prod();
    if (const auto* s = std::get_if<Sphere>(&shape))
        return 4.0 / 3.0 * pi * std::pow(s->radius_m, 3);
    if (const auto* s = std::get_if<Cylinder>(&shape))
        return pi * s->radius_m * s->radius_m * (s->to - s->from).norm();
    if (const auto* s = std::get_if<Tube>(&shape))
        return pi * (s->radius_m * s->radius_m - s->inner_radius_m * s->inner_radius_m) *
               (s->to - s->from).norm();
    const auto& s = std::get<MeshInstance>(shape);
    double sum = 0.0;
    for (const auto& [a, b, c] : s.mesh->triangles)
        sum += s.mesh->vertices[a].dot(s.mesh->vertices[b].cross(s.mesh->vertices[c])) / 6.0;
    return sum;
}

}  // namespace

TEST_CASE("Hits lie on the ray and on the surface, with the normal outward", "[property]") {
    const std::vector<Shape> shapes = one_of_each();
    RandomStream random = test_stream(20);
    for (const Shape& shape : shapes) {
        CAPTURE(shape.index());
        int hits = 0;
        for (int i = 0; i < 20000; ++i) {
            const Ray ray{random_point(random, 1.5), random_direction(random)};
            const auto hit = intersect(shape, ray, nullptr, infinity);
            if (!hit) continue;
            ++hits;
            REQUIRE((ray.origin + hit->distance_m * ray.direction - hit->position).norm() < 1e-13);
            REQUIRE(off_surface(shape, surface_point(*hit)) < 1e-14);
            REQUIRE_THAT(hit->normal.norm(), WithinAbs(1.0, 1e-14));
            if (is_solid(shape))
                REQUIRE((ray.direction.dot(hit->normal) > 0.0) == contains(shape, ray.origin));
            // Nothing nearer, and not this hit either, within its distance.
            REQUIRE_FALSE(intersect(shape, ray, nullptr, hit->distance_m).has_value());
        }
        CHECK(hits > 200);
    }
}

TEST_CASE("From its own surface a ray goes on to the next root", "[property]") {
    // Along one line, the hits found one from the other are those of a ray that starts anew just
    // behind each hit.
    RandomStream random = test_stream(21);
    for (const Shape& shape : one_of_each()) {
        CAPTURE(shape.index());
        for (int i = 0; i < 5000; ++i) {
            Ray ray{random_point(random, 1.5), random_direction(random)};
            auto hit = intersect(shape, ray, nullptr, infinity);
            for (int crossing = 0; hit; ++crossing) {
                REQUIRE(crossing < 6);
                const SurfacePoint start = surface_point(*hit);
                const auto next =
                    intersect(shape, {start.position, ray.direction}, &start, infinity);
                const auto anew =
                    intersect(shape, {start.position + 1e-9 * ray.direction, ray.direction},
                              nullptr, infinity);
                REQUIRE(next.has_value() == anew.has_value());
                if (!next) break;
                REQUIRE_THAT(next->distance_m, WithinAbs(anew->distance_m + 1e-9, 1e-12));
                REQUIRE(next->patch == anew->patch);
                hit = next;
            }
        }
    }
}

TEST_CASE("Reflections do not drift off the surface", "[property]") {
    const bool grazing = GENERATE(false, true);
    RandomStream random = test_stream(22);
    for (const Shape& shape : one_of_each()) {
        if (!is_solid(shape) || std::holds_alternative<MeshInstance>(shape)) continue;
        CAPTURE(shape.index(), grazing);
        SurfacePoint p = sample_area(shape, 0.3, 0.4);
        const Frame frame(p.normal);
        // Grazing: 1e-5 rad to the surface
        Vec3 direction = grazing ? Vec3(frame.tangent - 1e-5 * frame.normal).normalized()
                                 : scattered(p.normal, -1.0, random);
        double worst = 0.0;
        double length_m = 0.0;
        int lost = 0;
        for (int i = 0; i < 100000; ++i) {
            const auto hit = intersect(shape, {p.position, direction}, &p, infinity);
            if (!hit) {
                ++lost;
                break;
            }
            p = surface_point(*hit);
            length_m += hit->distance_m;
            worst = std::max(worst, off_surface(shape, p));
            direction = mirrored(direction, p.normal);
        }
        CHECK(lost == 0);
        CHECK(worst < 1e-15);
        CHECK(length_m > 0.1);
    }
}

TEST_CASE("A chain of mirror reflections in a sphere keeps its impact parameter", "[unit]") {
    // All chords of such a path have the same length.
    const Shape sphere = Sphere{Vec3(10, -20, 30), 0.005};
    SurfacePoint p = sample_area(sphere, 0.2, 0.7);
    const Frame frame(p.normal);
    Vec3 direction = (0.8 * frame.tangent - 0.6 * frame.normal).normalized();
    double last = 0.0;
    for (int i = 0; i < 100000; ++i) {
        const auto hit = intersect(sphere, {p.position, direction}, &p, infinity);
        REQUIRE(hit);
        last = hit->distance_m;
        p = surface_point(*hit);
        direction = mirrored(direction, p.normal);
    }
    // Rounding of coordinates of 30 m to 4e-15 m turns the ray by 1e-12 at each hit of this small
    // ball; over 1e5 hits as a random walk by 3e-10.
    CHECK_THAT(last, WithinRel(2.0 * 0.005 * 0.6, 1e-8));
}

TEST_CASE("Areas and volumes", "[unit]") {
    const std::vector<Shape> shapes = one_of_each();
    CHECK_THAT(area_m2(shapes[0]), WithinRel(0.45, 1e-14));
    CHECK_THAT(area_m2(shapes[1]), WithinRel(2 * (0.4 + 0.24 + 0.15), 1e-14));
    CHECK_THAT(area_m2(shapes[3]), WithinRel(pi * (0.49 - 0.0625), 1e-14));
    CHECK_THAT(area_m2(shapes[4]), WithinRel(4 * pi * 0.36, 1e-14));
    CHECK_THAT(area_m2(shapes[7]), WithinRel(area_m2(shapes[1]), 1e-14));
    CHECK_THAT(area_m2(Tube{Vec3(0, 0, 0), Vec3(0, 0, 2), 0.5, 0.25}),
               WithinRel(2 * pi * 0.75 * 2 + 2 * pi * (0.25 - 0.0625), 1e-14));

    RandomStream random = test_stream(23);
    for (const Shape& shape : shapes) {
        if (!is_solid(shape)) {
            CHECK_FALSE(contains(shape, sample_area(shape, 0.5, 0.5).position));
            continue;
        }
        CAPTURE(shape.index());
        const Eigen::AlignedBox3d box = bounds(shape);
        const int n = 40000;
        int inside = 0;
        for (int i = 0; i < n; ++i) {
            const Vec3 u = random_point(random, 0.5) + Vec3::Constant(0.5);
            if (contains(shape, box.min() + u.cwiseProduct(box.sizes()))) ++inside;
        }
        const double share = volume_m3(shape) / box.volume();
        CHECK_THAT(static_cast<double>(inside) / n,
                   WithinAbs(share, 4.89 * std::sqrt(share * (1.0 - share) / n)));
    }
}

TEST_CASE("Samples are uniform on the surface and within its bounds", "[statistical]") {
    const int n = 20000;
    RandomStream random = test_stream(24);
    for (const Shape& shape : one_of_each()) {
        CAPTURE(shape.index());
        // A kernel holds the share of samples that its area says, and each patch its own.
        std::vector<SurfacePoint> centres;
        for (int i = 0; i < 8; ++i) {
            const double u = random.uniform();
            centres.push_back(sample_area(shape, u, random.uniform()));
            centres.back().object = 0;
        }
        std::vector<int> in_kernel(centres.size(), 0);
        std::vector<int> in_patch(patch_count(shape), 0);
        Eigen::AlignedBox3d box = bounds(shape);
        Eigen::AlignedBox3d seen;
        for (int i = 0; i < n; ++i) {
            const double u = random.uniform();
            SurfacePoint q = sample_area(shape, u, random.uniform());
            q.object = 0;
            seen.extend(q.position);
            ++in_patch[q.patch];
            REQUIRE(off_surface(shape, q) < 1e-14);
            for (std::size_t k = 0; k < centres.size(); ++k)
                in_kernel[k] += within_kernel(shape, centres[k], q, 0.3) ? 1 : 0;
        }
        const auto check_share = [&](int count, double share) {
            CHECK_THAT(static_cast<double>(count) / n,
                       WithinAbs(share, 4.89 * std::sqrt(share * (1.0 - share) / n) + 1e-9));
        };
        for (std::size_t k = 0; k < centres.size(); ++k)
            check_share(in_kernel[k], kernel_area_m2(shape, centres[k], 0.3) / area_m2(shape));
        for (std::uint32_t patch = 0; patch < patch_count(shape); ++patch)
            check_share(in_patch[patch], patch_area_m2(shape, patch) / area_m2(shape));
        box.extend(box.min() - Vec3::Constant(1e-12));
        box.extend(box.max() + Vec3::Constant(1e-12));
        CHECK(box.contains(seen));
        CHECK((box.sizes() - seen.sizes()).maxCoeff() < 0.05);
    }
}

TEST_CASE("Samples of a shape follow its area", "[statistical]") {
    // Each map takes equal areas of the surface to equal areas of the unit square.
    using Map = std::function<std::array<double, 2>(const SurfacePoint&)>;
    const auto turns = [](double x, double y) { return std::atan2(y, x) / (2.0 * pi) + 0.5; };
    const Rectangle rectangle{{1, 2, 3}, {0, 0.7, 0}, {0, 0, 1.1}};
    const Disk annulus{{1, 2, 3}, {0, 0, 1}, 0.5, 0.2};
    const Sphere sphere{{1, 2, 3}, 0.4};
    const Cylinder cylinder{{0, 0, 1}, {0, 0, 1.8}, 0.3};  // sides 2 r h, ends r^2 each, times pi
    const Tube tube{{0, 0, 1}, {0, 0, 1.8}, 0.3, 0.1};
    const Box box{general_placement(), {0.5, 0.8, 0.3}};
    const MeshInstance triangle{prepare_mesh({{0, 0, 0}, {2, 0, 0}, {0.5, 1, 0}}, {{0, 1, 2}}),
                                Placement::Identity()};
    // Patches of the areas one behind the other, `part` of the way through the one of the number.
    const auto behind = [](const std::vector<double>& areas, std::uint32_t number, double part) {
        const auto first = areas.begin() + number;
        return (std::accumulate(areas.begin(), first, 0.0) + part * *first) /
               std::accumulate(areas.begin(), areas.end(), 0.0);
    };
    const auto along = [](const SurfacePoint& p) { return (p.position.z() - 1.0) / 0.8; };
    const std::vector<std::pair<Shape, Map>> shapes = {
        {rectangle,
         [](const auto& p) {
             return std::array{(p.position.y() - 2.0) / 0.7, (p.position.z() - 3.0) / 1.1};
         }},
        {annulus,
         [&](const auto& p) {
             const Vec3 d = p.position - annulus.centre;
             return std::array{(d.squaredNorm() - 0.04) / 0.21, turns(d.x(), d.y())};
         }},
        {sphere,
         [&](const auto& p) {
             const Vec3 d = (p.position - sphere.centre) / 0.4;
             return std::array{0.5 * (d.z() + 1.0), turns(d.x(), d.y())};
         }},
        {cylinder,
         [&](const auto& p) {
             const double r2 = p.position.x() * p.position.x() + p.position.y() * p.position.y();
             return std::array{behind({0.48, 0.09, 0.09}, p.patch, p.patch ? r2 / 0.09 : along(p)),
                               turns(p.position.x(), p.position.y())};
         }},
        {tube,
         [&](const auto& p) {
             const double r2 = p.position.x() * p.position.x() + p.position.y() * p.position.y();
             return std::array{behind({0.48, 0.16, 0.08, 0.08}, p.patch,
                                      p.patch > 1 ? (r2 - 0.01) / 0.08 : along(p)),
                               turns(p.position.x(), p.position.y())};
         }},
        {box,
         [&](const auto& p) {
             const Vec3 q = (box.placement.inverse() * p.position).cwiseQuotient(box.size_m);
             const auto axis = static_cast<Eigen::Index>(p.patch / 2);
             return std::array{
                 behind({0.24, 0.24, 0.15, 0.15, 0.4, 0.4}, p.patch, q[(axis + 1) % 3]),
                 q[(axis + 2) % 3]};
         }},
        {triangle, [](const auto& p) {
             // Share c of the third corner, and of the second in the rest.
             const double c = p.position.y(), b = (p.position.x() - 0.5 * c) / 2.0;
             return std::array{1.0 - (1.0 - c) * (1.0 - c), b / (1.0 - c)};
         }}};
    for (const auto& [shape, map] : shapes) {
        CAPTURE(shape.index());
        constexpr int side = 10, n = 40'000;
        RandomStream random = test_stream(29);
        std::vector<double> counts(side * side), crowded = counts;
        const auto count = [&](std::vector<double>& cells, double u1, double u2) {
            const auto [a, b] = map(sample_area(shape, u1, u2));
            const auto step = [](double x) {
                return std::clamp(static_cast<int>(x * side), 0, side - 1);
            };
            cells[static_cast<std::size_t>(step(a) * side + step(b))] += 1.0;
        };
        for (int i = 0; i < n; ++i) {
            const double u1 = random.uniform(), u2 = random.uniform();
            count(counts, u1, u2);
            count(crowded, std::pow(u1, 1.2), u2);  // the twin
        }
        const std::vector<double> even(counts.size(), n / static_cast<double>(side * side));
        test::check_follows(counts, even);
        CHECK(test::chi_square_deviate(crowded, even) > test::chi_square_limit);
    }
}

TEST_CASE("Rays into edges and corners of exact shapes are never lost", "[property]") {
    const Vec3 size(0.5, 0.8, 0.3);
    const Shape box = Box{general_placement(), size};
    const Shape cylinder = Cylinder{Vec3(-0.3, 0.1, -0.4), Vec3(0.2, 0.4, 0.5), 0.35};
    const Shape tube = Tube{Vec3(-0.3, 0.1, -0.4), Vec3(0.2, 0.4, 0.5), 0.45, 0.3};
    RandomStream random = test_stream(25);
    int lost = 0;
    for (int i = 0; i < 100000; ++i) {
        Vec3 target;  // on an edge or corner
        const Shape* shape = &box;
        if (i % 3 == 0) {
            target = random_point(random, 0.5) + Vec3::Constant(0.5);
            const int free_axis = static_cast<int>(4 * random.uniform());
            for (int axis = 0; axis < 3; ++axis)
                if (axis != free_axis) target[axis] = std::round(target[axis]);
            target = general_placement() * target.cwiseProduct(size);
        } else {
            shape = i % 3 == 1 ? &cylinder : &tube;
            const double radius_m = i % 3 == 1 ? 0.35 : (random.uniform() < 0.5 ? 0.45 : 0.3);
            const Vec3 from(-0.3, 0.1, -0.4);
            const Vec3 axis = Vec3(0.2, 0.4, 0.5) - from;
            const double angle = 2 * pi * random.uniform();
            target = from + std::round(random.uniform()) * axis +
                     Frame(axis.normalized())
                         .to_world(radius_m * Vec3(std::cos(angle), std::sin(angle), 0));
        }
        // Path: a point of the surface, to the edge, scattered inward there and on.
        const double u = random.uniform();
        SurfacePoint p = sample_area(*shape, u, random.uniform());
        Vec3 direction = (target - p.position).normalized();
        if (direction.dot(p.normal) > -1e-9) continue;  // along the same face
        for (int k = 0; k < 20; ++k) {
            const auto hit = intersect(*shape, {p.position, direction}, &p, infinity);
            if (!hit || direction.dot(hit->normal) < -1e-9) {
                ++lost;
                break;
            }
            p = surface_point(*hit);
            direction = scattered(p.normal, -1.0, random);
        }
    }
    CHECK(lost == 0);
}

}  // namespace lucerna::optics
