#include <catch2/catch.hpp>

#include "optics/geometry/ray_caster.h"
#include "optics/geometry/shape_parts.h"
#include "shapes_for_tests.h"

namespace lucerna::optics {

namespace {

/// Nearest hit among all shapes, each tried in double precision.
std::optional<std::pair<ObjectId, ShapeHit>> brute_force(const std::vector<Shape>& shapes,
                                                         const Ray& ray, double max_distance_m) {
    std::optional<std::pair<ObjectId, ShapeHit>> best;
    for (ObjectId object = 0; object < shapes.size(); ++object)
        if (const auto hit = intersect(shapes[object], ray, nullptr, max_distance_m)) {
            max_distance_m = hit->distance_m;
            best = {object, *hit};
        }
    return best;
}

/// Shapes of all kinds scattered through a room, some meshes instanced.
std::vector<Shape> crowd() {
    RandomStream random = test_stream(1);
    const auto ball = sphere_mesh(0.2, 10, 20);
    std::vector<Shape> shapes;
    for (int i = 0; i < 60; ++i) {
        const Vec3 p = random_point(random, 2.0);
        const Frame frame(random_direction(random));
        Placement placement = Placement::Identity();
        placement.translate(p);
        placement.rotate(Eigen::AngleAxisd(random.uniform(), frame.normal));
        switch (i % 7) {
            case 0:
                shapes.push_back(Rectangle{p, 0.5 * frame.tangent, 0.3 * frame.bitangent});
                break;
            case 1:
                shapes.push_back(Box{placement, Vec3(0.2, 0.3, 0.4)});
                break;
            case 2:
                shapes.push_back(Disk{p, frame.normal, 0.3, 0.1});
                break;
            case 3:
                shapes.push_back(Sphere{p, 0.25});
                break;
            case 4:
                shapes.push_back(Cylinder{p, p + 0.6 * frame.normal, 0.1});
                break;
            case 5:
                shapes.push_back(Tube{p, p + 0.4 * frame.normal, 0.2, 0.15});
                break;
            default:
                shapes.push_back(MeshInstance{ball, placement});
        }
    }
    shapes.push_back(MeshInstance{box_mesh(Vec3(0.7, 0.4, 0.6)), general_placement()});
    return shapes;
}

}  // namespace

TEST_CASE("Nearest hits agree with trying every shape", "[property]") {
    const std::vector<Shape> shapes = crowd();
    const RayCaster caster(shapes);
    RandomStream random = test_stream(2);
    int different = 0;
    int hits = 0;
    for (int i = 0; i < 100000; ++i) {
        const Ray ray{random_point(random, 2.0), random_direction(random)};
        const double reach_m = i % 2 == 0 ? infinity : 2.0;
        const auto expected = brute_force(shapes, ray, reach_m);
        const auto found = caster.intersect(ray, nullptr, reach_m);
        if (expected) ++hits;
        // Rays that graze a mesh's edge are decided in single precision.
        if (expected.has_value() != found.has_value() ||
            (expected && expected->first != found->point.object)) {
            ++different;
            continue;
        }
        if (!expected) continue;
        const bool is_mesh = std::holds_alternative<MeshInstance>(shapes[expected->first]);
        if (std::abs(expected->second.distance_m - found->distance_m) > (is_mesh ? 1e-5 : 0.0))
            ++different;
        if (!is_mesh) {
            REQUIRE(found->point.position == expected->second.position);
            REQUIRE(found->point.normal == expected->second.normal);
            REQUIRE(found->point.patch == expected->second.patch);
        }
    }
    CHECK(hits > 10000);
    CHECK(different < 5);
}

TEST_CASE("A ray reflected inside a closed shape is never lost", "[property]") {
    const bool mirror = GENERATE(true, false);
    const std::size_t kind = GENERATE(1, 4, 5, 6, 7, 8);
    CAPTURE(mirror, kind);
    const std::vector<Shape> shapes{one_of_each()[kind]};
    const RayCaster caster(shapes);
    RandomStream random = test_stream(3);
    SurfacePoint p = sample_area(shapes[0], 0.37, 0.61);
    p.object = 0;
    Vec3 direction = scattered(p.normal, -1.0, random);
    int lost = 0;
    for (int i = 0; i < 100000; ++i) {
        const auto hit = caster.intersect({p.position, direction}, &p);
        if (!hit || direction.dot(hit->point.normal) < 0.0) {
            ++lost;
            p = sample_area(shapes[0], random.uniform(), random.uniform());
            p.object = 0;
            direction = scattered(p.normal, -1.0, random);
            continue;
        }
        p = hit->point;
        direction = mirror ? mirrored(direction, p.normal) : scattered(p.normal, -1.0, random);
    }
    CHECK(lost == 0);
}

TEST_CASE("Closed meshes do not leak", "[property]") {
    // Also a wedge of 5 degrees, where single precision cannot tell the sides near the edge apart.
    const double slope = std::tan(5.0 * pi / 180.0);
    const auto wedge = prepare_mesh(
        {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 0, slope), Vec3(0, 1, 0), Vec3(1, 1, 0),
         Vec3(1, 1, slope)},
        {{0, 1, 2}, {3, 5, 4}, {0, 3, 4}, {0, 4, 1}, {1, 4, 5}, {1, 5, 2}, {0, 2, 5}, {0, 5, 3}});
    REQUIRE(wedge->closed);
    const auto mesh = GENERATE_COPY(box_mesh(Vec3(3.0, 0.8, 0.3)), sphere_mesh(0.5, 24, 48), wedge);
    const bool instanced = GENERATE(false, true);
    CAPTURE(mesh->triangles.size(), instanced);
    std::vector<Shape> shapes{MeshInstance{mesh, general_placement()}};
    if (instanced) {
        Placement elsewhere = general_placement();
        elsewhere.pretranslate(Vec3(5, 0, 0));
        shapes.push_back(MeshInstance{mesh, elsewhere});
    }
    const RayCaster caster(shapes);
    RandomStream random = test_stream(4);
    int lost = 0;
    const auto leaves_inside = [&](const std::optional<Hit>& hit, const Vec3& direction) {
        return hit && hit->point.object == 0 && direction.dot(hit->point.normal) > 0.0;
    };

    SECTION("from point to point of the surface, scattered on from there") {
        SurfacePoint p;
        for (int i = 0; i < 300000; ++i) {
            if (i % 100 == 0) {
                const double u = random.uniform();
                p = sample_area(shapes[0], u, random.uniform());
                p.object = 0;
            }
            const Vec3 direction = scattered(p.normal, -1.0, random);
            const auto hit = caster.intersect({p.position, direction}, &p);
            if (!leaves_inside(hit, direction)) {
                ++lost;
                continue;
            }
            p = hit->point;
        }
        CHECK(lost == 0);
    }
    SECTION("at edges and corners, and on from there") {
        Vec3 inside = Vec3::Zero();
        for (const Vec3& vertex : mesh->vertices)
            inside += vertex / static_cast<double>(mesh->vertices.size());
        inside = general_placement() * inside;
        for (int i = 0; i < 100000; ++i) {
            const auto& triangle = mesh->triangles[static_cast<std::size_t>(
                random.uniform() * static_cast<double>(mesh->triangles.size()))];
            const double share = i % 3 == 0 ? 0.0 : random.uniform();
            const Vec3 target =
                general_placement() * Vec3((1.0 - share) * mesh->vertices[triangle[0]] +
                                           share * mesh->vertices[triangle[1]]);
            Vec3 direction = (target - inside).normalized();
            auto hit = caster.intersect({inside, direction}, nullptr);
            for (int k = 0; k < 4; ++k) {
                if (!leaves_inside(hit, direction)) {
                    ++lost;
                    break;
                }
                const SurfacePoint p = hit->point;
                direction = scattered(p.normal, -1.0, random);
                hit = caster.intersect({p.position, direction}, &p);
            }
        }
        CHECK(lost == 0);
    }
    SECTION("to the outside a convex mesh does not hit itself") {
        int hits = 0;
        for (int i = 0; i < 100000; ++i) {
            const double u = random.uniform();
            SurfacePoint p = sample_area(shapes[0], u, random.uniform());
            p.object = 0;
            if (i % 4 == 0) {  // on an edge of its triangle
                const auto& triangle = mesh->triangles[p.primitive];
                p.position = general_placement() * Vec3(u * mesh->vertices[triangle[0]] +
                                                        (1.0 - u) * mesh->vertices[triangle[1]]);
            }
            const Vec3 direction = scattered(p.normal, 1.0, random);
            const auto hit = caster.intersect({p.position, direction}, &p);
            if (hit && hit->point.object == 0) ++hits;
        }
        CHECK(hits == 0);
    }
}

TEST_CASE("Occlusion agrees with trying every shape", "[property]") {
    const std::vector<Shape> shapes = crowd();
    const RayCaster caster(shapes);
    RandomStream random = test_stream(5);
    int different = 0;
    int occluded = 0;
    int visible = 0;
    for (int i = 0; i < 60000; ++i) {
        const auto point = [&] {
            const auto object = static_cast<ObjectId>(random.uniform() * 61.0);
            const double u = random.uniform();
            SurfacePoint p = sample_area(shapes[object], u, random.uniform());
            p.object = object;
            return p;
        };
        const SurfacePoint from = point();
        SurfacePoint to = point();
        if (i % 5 == 0) {  // another point of the same object
            const double u = random.uniform();
            to = sample_area(shapes[from.object], u, random.uniform());
            to.object = from.object;
        }
        const Vec3 step = to.position - from.position;
        const Ray ray{from.position, step.normalized()};
        // Along either surface, a picometre's gap is not enough.
        if (std::abs(ray.direction.dot(from.normal)) < 1e-4 ||
            std::abs(ray.direction.dot(to.normal)) < 1e-4)
            continue;
        // Anything in between, a picometre off the ends
        const double gap_m = 1e-12;
        bool expected = false;
        for (const Shape& shape : shapes)
            expected =
                expected || intersect(shape, {ray.origin + gap_m * ray.direction, ray.direction},
                                      nullptr, step.norm() - 2 * gap_m)
                                .has_value();
        const bool found = caster.occluded(from.position, &from, to.position, &to);
        REQUIRE(caster.occluded(to.position, &to, from.position, &from) == found);
        if (found != expected) ++different;
        (expected ? occluded : visible) += 1;
    }
    CHECK(occluded > 5000);
    CHECK(visible > 5000);
    CHECK(different == 0);
}

TEST_CASE("A surface does not hide itself from its inside", "[unit]") {
    const Tube tube{Vec3(0, 0, 0), Vec3(0, 0, 1), 0.5, 0.4};
    const auto room = sphere_mesh(1.0, 16, 32);
    const std::vector<Shape> shapes{Sphere{Vec3(10, 0, 0), 1.0},
                                    Cylinder{Vec3(20, 0, 0), Vec3(20, 0, 1), 0.5}, tube,
                                    MeshInstance{room, Placement(Eigen::Translation3d(30, 0, 0))}};
    const RayCaster caster(shapes);
    RandomStream random = test_stream(6);
    const auto sample = [&](ObjectId object) {
        const double u = random.uniform();
        SurfacePoint p = sample_area(shapes[object], u, random.uniform());
        p.object = object;
        return p;
    };
    for (int i = 0; i < 5000; ++i)
        for (const ObjectId object : {0u, 1u, 3u}) {
            const SurfacePoint p = sample(object);
            const SurfacePoint q = sample(object);
            if (p.primitive == q.primitive && object == 3) continue;
            REQUIRE_FALSE(caster.occluded(p.position, &p, q.position, &q));
            // From outside, the near side hides the far side and is itself seen.
            const Vec3 outside = p.position + 3.0 * p.normal;
            REQUIRE_FALSE(caster.occluded(outside, nullptr, p.position, &p));
            if (object == 0) {
                SurfacePoint far = p;
                far.position -= 2.0 * p.normal;
                far.normal = -p.normal;
                REQUIRE(caster.occluded(outside, nullptr, far.position, &far));
            }
        }
    // Across the bore of a tube, and through its wall.
    SurfacePoint a{Vec3(0.4, 0, 0.5), Vec3(-1, 0, 0), 2, 1, 1};
    SurfacePoint b{Vec3(-0.4, 0, 0.5), Vec3(1, 0, 0), 2, 1, 1};
    SurfacePoint c{Vec3(-0.5, 0, 0.5), Vec3(-1, 0, 0), 2, 0, 0};
    CHECK_FALSE(caster.occluded(a.position, &a, b.position, &b));
    CHECK(caster.occluded(a.position, &a, c.position, &c));
    CHECK_FALSE(caster.occluded(b.position, &b, c.position, &c));
    // A point between two sheets sees both, and they do not see each other past a third.
    const std::vector<Shape> sheets{Disk{Vec3(0, 0, 0), Vec3(0, 0, 1), 1},
                                    Disk{Vec3(0, 0, 1), Vec3(0, 0, 1), 0.5},
                                    Disk{Vec3(0, 0, 2), Vec3(0, 0, 1), 1}};
    const RayCaster between(sheets);
    const SurfacePoint low{Vec3(0, 0, 0), Vec3(0, 0, 1), 0, 0, 0};
    const SurfacePoint high{Vec3(0, 0, 2), Vec3(0, 0, 1), 2, 0, 0};
    CHECK(between.occluded(low.position, &low, high.position, &high));
    CHECK_FALSE(between.occluded(low.position, &low, Vec3(0, 0, 0.999), nullptr));
    CHECK(between.occluded(low.position, &low, Vec3(0, 0, 1.001), nullptr));
    CHECK_FALSE(between.occluded(low.position, &low, low.position, &low));
}

TEST_CASE("Rays from afar and scenes far from the origin lose no digits", "[unit]") {
    // A 1 mm mesh box of a map grid, seen from 100 km: in single precision 100 km counts in 8 mm.
    const Vec3 place(4.5e5, 5.4e6, 300.0);
    Placement placement(Eigen::Translation3d{place});
    const std::vector<Shape> shapes{MeshInstance{box_mesh(Vec3(1e-3, 1e-3, 1e-3)), placement},
                                    Sphere{place + Vec3(5e-3, 0, 0), 1e-3}};
    const RayCaster caster(shapes);
    RandomStream random = test_stream(7);
    for (int i = 0; i < 1000; ++i) {
        const Vec3 target =
            place +
            Vec3(1e-3, 1e-3, 1e-3).cwiseProduct(random_point(random, 0.45) + Vec3::Constant(0.5));
        const Vec3 direction = random_direction(random);
        const auto hit = caster.intersect({target - 1e5 * direction, direction}, nullptr);
        REQUIRE(hit);
        // A double of 5e6 m has steps of 1e-9 m.
        if (hit->point.object == 0)
            CHECK((hit->point.position - place - Vec3::Constant(5e-4)).cwiseAbs().maxCoeff() <
                  5e-4 + 1e-8);
    }
}

TEST_CASE("The solids that contain a point", "[unit]") {
    const std::vector<Shape> shapes = one_of_each();
    const RayCaster caster(shapes);
    RandomStream random = test_stream(8);
    int found = 0;
    for (int i = 0; i < 2000; ++i) {
        const Vec3 p = random_point(random, 1.0);
        std::vector<ObjectId> expected;
        for (ObjectId object = 0; object < shapes.size(); ++object) {
            if (!is_solid(shapes[object])) continue;
            // Inside, the first hit in any direction is one from within.
            const auto hit =
                intersect(shapes[object], {p, random_direction(random)}, nullptr, infinity);
            // The bore of a tube is outside though rays out of it may hit nothing.
            if (!hit) continue;
            const auto& [origin, direction] = Ray{p, (hit->position - p).normalized()};
            if (direction.dot(hit->normal) > 0.0) expected.push_back(object);
        }
        CHECK(caster.containing(p) == expected);
        found += static_cast<int>(expected.size());
    }
    CHECK(found > 500);
}

TEST_CASE("A scene without objects has no hits", "[unit]") {
    const RayCaster caster(std::vector<Shape>{});
    const Ray ray{Vec3(0, 0, 0), Vec3(0, 0, 1)};
    CHECK_FALSE(caster.intersect(ray, nullptr).has_value());
    CHECK_FALSE(caster.occluded(Vec3(0, 0, 0), nullptr, Vec3(0, 0, 9), nullptr));
    CHECK(caster.containing(Vec3(0, 0, 0)).empty());
    CHECK(caster.raw_intersect(std::vector<Ray>{ray}) == 0);
    CHECK(caster.scene_radius_m() == 0.0);
}

TEST_CASE("The bare library call finds the same hits", "[unit]") {
    const std::vector<Shape> shapes = crowd();
    const RayCaster caster(shapes);
    RandomStream random = test_stream(9);
    std::vector<Ray> rays;
    for (int i = 0; i < 20000; ++i)
        rays.push_back({random_point(random, 2.0), random_direction(random)});
    std::size_t hits = 0;
    for (const Ray& ray : rays) hits += caster.intersect(ray, nullptr) ? 1 : 0;
    // But for a ray or two that start within rounding of a mesh
    CHECK(std::abs(static_cast<double>(caster.raw_intersect(rays)) - static_cast<double>(hits)) <=
          2.0);
}

}  // namespace lucerna::optics
