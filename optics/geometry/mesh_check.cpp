#include "optics/geometry/mesh_check.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>
#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "optics/geometry/mesh_edges.h"

namespace lucerna::optics {

namespace {

namespace processing = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using SurfaceMesh = CGAL::Surface_mesh<Point>;

/// The mesh as CGAL sees it, without unused vertices.
struct WeldedSoup {
    std::vector<Point> points;
    std::vector<std::array<std::size_t, 3>> triangles;
};

WeldedSoup weld(const Mesh& mesh, const std::vector<std::uint32_t>& welded) {
    WeldedSoup soup;
    std::vector<std::size_t> index(mesh.vertices.size());
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
        if (welded[i] != i) continue;
        index[i] = soup.points.size();
        soup.points.emplace_back(mesh.vertices[i].x(), mesh.vertices[i].y(), mesh.vertices[i].z());
    }
    for (const auto& [a, b, c] : mesh.triangles)
        soup.triangles.push_back({index[welded[a]], index[welded[b]], index[welded[c]]});
    return soup;
}

}  // namespace

MeshReport check_mesh(const Mesh& mesh) {
    MeshReport report;
    const std::vector<std::uint32_t> welded = weld_vertices(mesh.vertices);
    for_each_edge(mesh, welded, [&](std::span<const TriangleSide> sides) {
        switch (edge_kind(sides)) {
            case EdgeKind::regular:
                break;
            case EdgeKind::inconsistent:
                ++report.inconsistent_edges;
                break;
            case EdgeKind::border:
                ++report.border_edges;
                break;
            case EdgeKind::crowded:
                ++report.crowded_edges;
                break;
        }
    });
    report.closed = report.inconsistent_edges + report.border_edges + report.crowded_edges == 0;

    WeldedSoup soup = weld(mesh, welded);
    for (const auto& [a, b, c] : soup.triangles)
        if (CGAL::collinear(soup.points[a], soup.points[b], soup.points[c]))
            ++report.degenerate_triangles;

    if (!processing::is_polygon_soup_a_polygon_mesh(soup.triangles)) return report;
    SurfaceMesh surface;
    processing::polygon_soup_to_polygon_mesh(soup.points, soup.triangles, surface);
    // CGAL names each degenerate triangle as a pair with itself.
    using Pair = std::pair<SurfaceMesh::Face_index, SurfaceMesh::Face_index>;
    std::vector<Pair> pairs;
    processing::self_intersections(surface, std::back_inserter(pairs));
    report.self_intersections = static_cast<std::size_t>(std::count_if(
        pairs.begin(), pairs.end(), [](const Pair& pair) { return pair.first != pair.second; }));
    if (report.closed && pairs.empty())
        report.oriented_outward =
            processing::is_outward_oriented(surface) && processing::does_bound_a_volume(surface);
    return report;
}

std::vector<std::string> MeshReport::complaints() const {
    std::vector<std::string> list;
    const auto count = [&](std::size_t number, const char* what) {
        if (number > 0) list.push_back(fmt::format("{} {}", number, what));
    };
    count(border_edges, "edges have one triangle only: the surface has a hole or is a sheet");
    count(crowded_edges, "edges have three triangles or more");
    count(inconsistent_edges, "edges join triangles of opposite orientation");
    count(degenerate_triangles, "triangles have their corners on a line");
    if (self_intersections) count(*self_intersections, "pairs of triangles cut each other");
    if (!self_intersections)
        list.emplace_back("the surface is too tangled to look for triangles that cut each other");
    if (closed && self_intersections == std::size_t{0} && degenerate_triangles == 0 &&
        !oriented_outward)
        list.emplace_back("the surface is closed, but its normals point inward");
    return list;
}

}  // namespace lucerna::optics
