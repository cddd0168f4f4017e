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

}  // namespace lucerna::optics
