#include <catch2/catch.hpp>
#include <functional>

#include "optics/geometry/disc_area.h"
#include "shapes_for_tests.h"

namespace lucerna::optics {

namespace {

using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

/// A patch as an area-preserving map of the unit square, written apart from the code under test.
struct PatchMap {
    std::string name;
    Shape shape;
    std::uint32_t patch;
    std::function<Vec3(double, double)> position;
};

std::vector<PatchMap> patch_maps() {
    const Placement placement = general_placement();
    const auto placed = [placement](double x, double y, double z) -> Vec3 {
        return placement * Vec3(x, y, z);
    };
    const auto ring = [placed](double inner, double outer, double z) {
        return [=](double u, double v) {
            const double r = std::sqrt(inner * inner + u * (outer * outer - inner * inner));
            return placed(r * std::cos(2 * pi * v), r * std::sin(2 * pi * v), z);
        };
    };
    const auto side = [placed](double r, double height) {
        return [=](double u, double v) {
            return placed(r * std::cos(2 * pi * v), r * std::sin(2 * pi * v), u * height);
        };
    };
    const Vec3 from = placed(0, 0, 0);
    const Vec3 to = placed(0, 0, 1.5);
    const Vec3 up = placement.linear() * Vec3(0, 0, 1);
    const Cylinder cylinder{from, to, 0.4};
    const Tube tube{from, to, 0.4, 0.3};
    const Box box{placement, Vec3(0.5, 0.8, 1.5)};
    const Vec3 edge_u = placement.linear() * Vec3(2.0, 0, 0);
    const Vec3 edge_v = placement.linear() * Vec3(0, 0.5, 0);
    return {
        {"rectangle", Rectangle{from, edge_u, edge_v}, 0,
         [=](double u, double v) { return placed(2.0 * u, 0.5 * v, 0); }},
        {"box -x", box, 0, [=](double u, double v) { return placed(0, 0.8 * u, 1.5 * v); }},
        {"box +y", box, 3, [=](double u, double v) { return placed(0.5 * u, 0.8, 1.5 * v); }},
        {"box +z", box, 5, [=](double u, double v) { return placed(0.5 * u, 0.8 * v, 1.5); }},
        {"disk", Disk{from, up, 0.7}, 0, ring(0, 0.7, 0)},
        {"annulus", Disk{from, up, 0.7, 0.3}, 0, ring(0.3, 0.7, 0)},
        {"sphere", Sphere{from, 0.6}, 0,
         [=](double u, double v) {
             const double z = 2 * u - 1;
             const double r = std::sqrt(1 - z * z);
             return placed(0.6 * r * std::cos(2 * pi * v), 0.6 * r * std::sin(2 * pi * v), 0.6 * z);
         }},
        {"cylinder side", cylinder, 0, side(0.4, 1.5)},
        {"cylinder cap", cylinder, 2, ring(0, 0.4, 1.5)},
        {"tube outer side", tube, 0, side(0.4, 1.5)},
        {"tube inner side", tube, 1, side(0.3, 1.5)},
        {"tube end", tube, 2, ring(0.3, 0.4, 0)},
    };
}

/// Share of the patch that lies in the kernel, by the midpoint rule on n x n cells of equal area.
double kernel_share(const PatchMap& map, const SurfacePoint& p, double radius_m, int n) {
    int inside = 0;
    SurfacePoint q = p;
    for (int i = 0; i < n; ++i)
        for (int k = 0; k < n; ++k) {
            q.position = map.position((i + 0.5) / n, (k + 0.5) / n);
            inside += within_kernel(map.shape, p, q, radius_m) ? 1 : 0;
        }
    return static_cast<double>(inside) / (n * n);
}

}  // namespace

TEST_CASE("Kernel areas of exact shapes agree with counting cells", "[unit]") {
    RandomStream random = test_stream(10);
    for (const PatchMap& map : patch_maps()) {
        const double area = patch_area_m2(map.shape, map.patch);
        for (const double radius_m : {0.03, 0.17, 0.45, 0.9, 1.3, 2.5}) {
            const double u = random.uniform();
            SurfacePoint p;
            p.object = 3;
            p.patch = p.primitive = map.patch;
            p.position = map.position(u, random.uniform());
            const double counted = area * kernel_share(map, p, radius_m, 500);
            CAPTURE(map.name, radius_m, area);
            // Cells on the kernel's border: its length / cell size of them, half a cell each at
            // random; 2e-3 of the patch is far above, and far below any wrong term.
            CHECK_THAT(kernel_area_m2(map.shape, p, radius_m), WithinAbs(counted, 2e-3 * area));
        }
        SurfacePoint p;
        p.patch = map.patch;
        p.position = map.position(0.5, 0.25);
        CHECK_THAT(kernel_area_m2(map.shape, p, 10.0), WithinRel(area, 1e-12));
    }
}

TEST_CASE("A kernel around a cylinder is measured on the unrolled side", "[unit]") {
    // Across the diameter the chord is 2 R but the way along the side pi R: no kernel of radius 2.5
    // R reaches over, though a ball would.
    const Cylinder cylinder{Vec3(0, 0, 0), Vec3(0, 0, 10), 1.0};
    SurfacePoint p{.position = Vec3(1, 0, 5), .normal = Vec3(1, 0, 0), .object = 0};
    SurfacePoint q{.position = Vec3(-1, 0, 5), .normal = Vec3(-1, 0, 0), .object = 0};
    CHECK_FALSE(within_kernel(cylinder, p, q, 2.5));
    CHECK(within_kernel(cylinder, p, q, 3.2));
    // A disc of radius 2.5 < pi R lies flat on the unrolled side.
    CHECK_THAT(kernel_area_m2(cylinder, p, 2.5), WithinRel(pi * 2.5 * 2.5, 1e-12));
    // r = 4 > pi: the parts of the disc beyond the line opposite to p are cut off on both sides.
    const double cap = 16.0 * std::acos(pi / 4.0) - pi * std::sqrt(16.0 - pi * pi);
    CHECK_THAT(kernel_area_m2(cylinder, p, 4.0), WithinRel(pi * 16.0 - 2.0 * cap, 1e-12));
    q.patch = 1;
    CHECK_FALSE(within_kernel(cylinder, p, q, 100.0));
    q.patch = 0;
    q.object = 1;
    CHECK_FALSE(within_kernel(cylinder, p, q, 100.0));
}

TEST_CASE("Discs and plane figures", "[unit]") {
    // Lens of two unit circles at distance 1 (MathWorld, Circle-Circle Intersection, eq. 14).
    CHECK_THAT(disc_disc_area(1.0, 1.0, 1.0), WithinRel(2 * pi / 3 - std::sqrt(3.0) / 2, 1e-14));
    CHECK(disc_disc_area(2.0, 1.0, 1.0) == 0.0);
    CHECK_THAT(disc_disc_area(0.3, 1.0, 0.5), WithinRel(pi * 0.25, 1e-14));
    CHECK(disc_disc_area(0.3, 1.0, 0.0) == 0.0);
    // Tiny lens near contact: 2/3 of width times height in the limit.
    const double overlap = 1e-6;
    CHECK_THAT(disc_disc_area(2.0 - overlap, 1.0, 1.0),
               WithinRel(2.0 / 3.0 * overlap * 2.0 * std::sqrt(overlap), 1e-3));
    // Quarter disc at a corner, half disc at an edge.
    CHECK_THAT(disc_rectangle_area(0, 0, 2, 3, 1), WithinRel(pi / 4, 1e-14));
    CHECK_THAT(disc_rectangle_area(1, 0, 2, 3, 1), WithinRel(pi / 2, 1e-14));
    CHECK_THAT(disc_rectangle_area(1, 1.5, 2, 3, 9), WithinRel(6.0, 1e-14));
    // A disc outside of the rectangle that reaches into it over one edge: a circular segment.
    CHECK_THAT(disc_rectangle_area(5, -0.5, 10, 10, 1.0),
               WithinRel(std::acos(0.5) - 0.5 * std::sqrt(0.75), 1e-12));
}

TEST_CASE("Kernel areas of meshes agree with counting small triangles", "[unit]") {
    struct Case {
        std::string name;
        std::shared_ptr<const Mesh> mesh;
    };
    for (const auto& [name, mesh] :
         {Case{"box", box_mesh(Vec3(0.5, 0.8, 0.3))}, Case{"sphere", sphere_mesh(0.5, 20, 40)},
          Case{"prism", sphere_mesh(0.5, 4, 6)}}) {
        const Shape shape = MeshInstance{mesh, general_placement()};
        RandomStream random = test_stream(11);
        for (const double radius_m : {0.05, 0.2, 0.5, 2.0}) {
            const double u = random.uniform();
            SurfacePoint p = sample_area(shape, u, random.uniform());
            p.object = 0;
            // n^2 congruent parts of each triangle, each with its centroid
            const int n = 40 * 15 / static_cast<int>(std::sqrt(mesh->triangles.size()) + 10);
            double counted = 0.0;
            for (std::uint32_t i = 0; i < mesh->triangles.size(); ++i) {
                const auto& [a, b, c] = mesh->triangles[i];
                SurfacePoint q;
                q.object = 0;
                q.patch = mesh->patches[i];
                for (int k = 0; k < n * n; ++k) {
                    const int row = static_cast<int>(std::sqrt(k + 0.5));
                    const int column = k - row * row;  // of 2 row + 1 parts
                    const double fall = row + (column % 2 == 0 ? 2.0 / 3.0 : 1.0 / 3.0);
                    const double along = column / 2 + (column % 2 == 0 ? 1.0 / 3.0 : 2.0 / 3.0);
                    q.position = general_placement() *
                                 Vec3(mesh->vertices[a] +
                                      (fall - along) / n * (mesh->vertices[b] - mesh->vertices[a]) +
                                      along / n * (mesh->vertices[c] - mesh->vertices[a]));
                    if (within_kernel(shape, p, q, radius_m))
                        counted += mesh->areas_m2[i] / (n * n);
                }
            }
            CAPTURE(name, radius_m, n);
            CHECK_THAT(kernel_area_m2(shape, p, radius_m),
                       WithinAbs(counted, 4e-3 * patch_area_m2(shape, p.patch)));
        }
    }
}

TEST_CASE("The patch of a box mesh is the face of the box", "[unit]") {
    const Vec3 size(0.5, 0.8, 0.3);
    const Shape mesh = MeshInstance{box_mesh(size), general_placement()};
    const Shape box = Box{general_placement(), size};
    CHECK(patch_count(mesh) == 6);
    RandomStream random = test_stream(12);
    for (int i = 0; i < 200; ++i) {
        const double u = random.uniform();
        SurfacePoint on_mesh = sample_area(mesh, u, random.uniform());
        // The same point of the box, whose patch follows from the normal.
        const Vec3 normal = general_placement().linear().transpose() * on_mesh.normal;
        SurfacePoint on_box = on_mesh;
        Eigen::Index axis;
        normal.cwiseAbs().maxCoeff(&axis);
        on_box.patch = static_cast<std::uint32_t>(2 * axis + (normal[axis] > 0 ? 1 : 0));
        CHECK_THAT(patch_area_m2(mesh, on_mesh.patch),
                   WithinRel(patch_area_m2(box, on_box.patch), 1e-12));
        const double radius_m = 0.6 * random.uniform();
        CHECK_THAT(kernel_area_m2(mesh, on_mesh, radius_m),
                   WithinRel(kernel_area_m2(box, on_box, radius_m), 1e-9));
    }
}

TEST_CASE("A kernel on a finely meshed sphere is a disc but for its curvature", "[unit]") {
    // 20000 triangles, kernel of about 700: a wrong sum over the search tree would show.
    const double radius_m = 0.5;
    const Shape sphere = MeshInstance{sphere_mesh(radius_m, 100, 200), Placement::Identity()};
    CHECK(patch_count(sphere) == 1);
    RandomStream random = test_stream(13);
    for (int i = 0; i < 50; ++i) {
        const double u = random.uniform();
        const SurfacePoint p = sample_area(sphere, u, random.uniform());
        // The facets lie up to R (1 - cos(pi/100)) = 5e-4 R below the sphere.
        CHECK_THAT(kernel_area_m2(sphere, p, 0.2), WithinRel(pi * 0.04, 3e-3));
    }
}

namespace {

/// [0, 1] x [0, 1] in steps x steps squares, without those that are left out.
std::shared_ptr<const Mesh> plate_mesh(std::uint32_t steps,
                                       const std::function<bool(double x, double y)>& leaves_out,
                                       const std::function<Vec3(const Vec3&)>& moved) {
    std::vector<Vec3> vertices;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    for (std::uint32_t i = 0; i <= steps; ++i)
        for (std::uint32_t j = 0; j <= steps; ++j)
            vertices.push_back(
                moved(Vec3(static_cast<double>(i) / steps, static_cast<double>(j) / steps, 0.0)));
    for (std::uint32_t i = 0; i < steps; ++i)
        for (std::uint32_t j = 0; j < steps; ++j) {
            if (leaves_out((i + 0.5) / steps, (j + 0.5) / steps)) continue;
            const std::uint32_t a = i * (steps + 1) + j;
            const std::uint32_t b = a + steps + 1;
            triangles.push_back({a, b, b + 1});
            triangles.push_back({a, b + 1, a + 1});
        }
    return prepare_mesh(vertices, triangles);
}

bool in_nothing(double, double) {
    return false;
}

Vec3 as_it_is(const Vec3& p) {
    return p;
}

}  // namespace

TEST_CASE("The outline of a plane patch are its straight sides", "[unit]") {
    CHECK(box_mesh(Vec3(0.5, 0.8, 0.3))->outlines.of(2).size() == 4);
    CHECK(plate_mesh(20, in_nothing, as_it_is)->outlines.of(0).size() == 4);
    // More squares in a row than are joined at once.
    CHECK(plate_mesh(100, in_nothing, as_it_is)->outlines.of(0).size() == 4);
    const auto hole = [](double x, double y) {
        return std::abs(x - 0.5) < 0.1 && std::abs(y - 0.5) < 0.1;
    };
    CHECK(plate_mesh(20, hole, as_it_is)->outlines.of(0).size() == 8);
    const auto corner = [](double x, double y) { return x > 0.5 && y > 0.5; };
    CHECK(plate_mesh(20, corner, as_it_is)->outlines.of(0).size() == 6);

    // Digits of single precision in a general position leave a plane plane.
    const auto rounded = [](const Vec3& p) -> Vec3 {
        return (general_placement() * p).cast<float>().cast<double>();
    };
    CHECK(plate_mesh(4, in_nothing, rounded)->outlines.is_plane(0));
    // A bend by a degree and a bump of a ten-thousandth do not.
    const auto bent = [](const Vec3& p) -> Vec3 {
        return {p.x(), p.y(), 0.017 * std::max(0.0, p.x() - 0.5)};
    };
    CHECK_FALSE(plate_mesh(4, in_nothing, bent)->outlines.is_plane(0));
    const auto bump = [](const Vec3& p) -> Vec3 {
        return {p.x(), p.y(), p.x() == 0.5 && p.y() == 0.5 ? 1e-4 : 0.0};
    };
    CHECK_FALSE(plate_mesh(4, in_nothing, bump)->outlines.is_plane(0));
    CHECK_FALSE(sphere_mesh(0.5, 20, 40)->outlines.is_plane(0));
    // Nor a triangle twice, joined by what is around it.
    const auto twice = prepare_mesh({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {1, 0, 0}},
                                    {{0, 1, 2}, {0, 2, 3}, {0, 4, 2}});
    for (std::uint32_t patch = 0; patch < twice->patch_areas_m2.size(); ++patch) {
        const Shape shape = MeshInstance{twice, Placement::Identity()};
        SurfacePoint p{.position = Vec3(0.5, 0.5, 0.0), .normal = Vec3::UnitZ(), .patch = patch};
        while (twice->patches[p.primitive] != patch) ++p.primitive;
        CHECK_THAT(kernel_area_m2(shape, p, 9.0), WithinRel(twice->patch_areas_m2[patch], 1e-12));
    }
}

TEST_CASE("Kernel areas beside holes and corners of a plane mesh", "[unit]") {
    struct Case {
        std::string name;
        std::function<bool(double x, double y)> leaves_out;
        double low_m, size_m;  // of the square that is left out, along both axes
    };
    for (const auto& [name, leaves_out, low_m, size_m] :
         {Case{
              "hole",
              [](double x, double y) { return std::abs(x - 0.5) < 0.1 && std::abs(y - 0.5) < 0.1; },
              0.4, 0.2},
          Case{"corner", [](double x, double y) { return x > 0.5 && y > 0.5; }, 0.5, 0.5}}) {
        const Shape shape = MeshInstance{plate_mesh(20, leaves_out, as_it_is), general_placement()};
        RandomStream random = test_stream(14);
        int cut = 0;
        for (int i = 0; i < 500; ++i) {
            const double u = random.uniform();
            const SurfacePoint p = sample_area(shape, u, random.uniform());
            const double radius_m = 0.4 * random.uniform();
            const Vec3 on_plate = general_placement().inverse() * p.position;
            const double x = on_plate.x(), y = on_plate.y();
            const double left_out_m2 =
                disc_rectangle_area(x - low_m, y - low_m, size_m, size_m, radius_m);
            const double truth_m2 = disc_rectangle_area(x, y, 1.0, 1.0, radius_m) - left_out_m2;
            cut += left_out_m2 > 0.01 * truth_m2 ? 1 : 0;
            CAPTURE(name, x, y, radius_m);
            CHECK_THAT(kernel_area_m2(shape, p, radius_m), WithinRel(truth_m2, 1e-9));
        }
        CHECK(cut > 100);  // the twin: it mattered
    }
}

}  // namespace lucerna::optics
