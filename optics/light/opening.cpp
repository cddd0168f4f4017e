#include "optics/light/opening.h"

#include <fmt/format.h>

#include <cstdint>
#include <vector>

namespace lucerna::optics {
namespace {

constexpr std::uint32_t segments = 64;         // of ellipses and cylinders
constexpr std::uint32_t sphere_segments = 32;  // fewer, because each facet is a face of its own
constexpr std::uint32_t rings = 16;

// Collects polygons as triangle fans; the order of the corners gives the normal.
struct MeshBuilder {
    Mesh mesh;

    std::uint32_t vertex(const Vec3& position) {
        mesh.vertices.push_back(position);
        return static_cast<std::uint32_t>(mesh.vertices.size() - 1);
    }
    void polygon(const std::vector<std::uint32_t>& corners) {
        for (std::size_t i = 2; i < corners.size(); ++i) {
            mesh.triangles.push_back({corners[0], corners[i - 1], corners[i]});
        }
    }
    void polygon_of(const std::vector<Vec3>& corners) {
        std::vector<std::uint32_t> ids;
        for (const Vec3& corner : corners) ids.push_back(vertex(corner));
        polygon(ids);
    }
};

// Two axes that span the plane across `axis`, right-handed with it.
std::array<Vec3, 3> axes(Opening::Axis axis) {
    switch (axis) {
        case Opening::Axis::x:
            return {Vec3::UnitY(), Vec3::UnitZ(), Vec3::UnitX()};
        case Opening::Axis::y:
            return {Vec3::UnitZ(), Vec3::UnitX(), Vec3::UnitY()};
        case Opening::Axis::z:
            break;
    }
    return {Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};
}

// Corners of the ellipse across `axis`, counter-clockwise around it, as a polygon of equal area.
std::vector<Vec3> ellipse_corners(const Opening& opening) {
    constexpr double step = 2.0 * pi / segments;
    const double scale = std::sqrt(step / std::sin(step));
    const auto [u, v, w] = axes(opening.axis);
    std::vector<Vec3> corners;
    for (std::uint32_t i = 0; i < segments; ++i) {
        const double angle = (i + 0.5) * step;
        const Vec3 on_unit = std::cos(angle) * u + std::sin(angle) * v;
        corners.push_back(0.5 * scale * opening.size_m.cwiseProduct(on_unit));
    }
    return corners;
}

// Corners of the rectangle across `axis`, counter-clockwise around it.
std::vector<Vec3> rectangle_corners(const Opening& opening) {
    const auto [u, v, w] = axes(opening.axis);
    const Vec3 half = 0.5 * opening.size_m;
    return {half.cwiseProduct(-u - v), half.cwiseProduct(u - v), half.cwiseProduct(u + v),
            half.cwiseProduct(v - u)};
}

Mesh sheet(std::vector<Vec3> corners, Opening::Axis axis) {
    if (axis == Opening::Axis::z) corners = {corners.rbegin(), corners.rend()};  // faces down
    MeshBuilder builder;
    builder.polygon_of(corners);
    return builder.mesh;
}

Mesh box(const Opening& opening) {
    const Vec3 h = 0.5 * opening.size_m;
    MeshBuilder builder;
    builder.polygon_of({{-h.x(), -h.y(), -h.z()},
                        {-h.x(), h.y(), -h.z()},
                        {h.x(), h.y(), -h.z()},
                        {h.x(), -h.y(), -h.z()}});
    builder.polygon_of({{-h.x(), -h.y(), h.z()},
                        {h.x(), -h.y(), h.z()},
                        {h.x(), h.y(), h.z()},
                        {-h.x(), h.y(), h.z()}});
    for (std::size_t side = 0; side < 4; ++side) {
        const double height_m = opening.side_heights_m[side];
        if (height_m == 0.0) continue;
        // Faces C0, C90, C180, C270: the outward normal and the edge along the side.
        const Vec3 normal =
            std::array<Vec3, 4>{Vec3::UnitX(), Vec3::UnitY(), -Vec3::UnitX(), -Vec3::UnitY()}[side];
        const Vec3 along = Vec3::UnitZ().cross(normal);
        const Vec3 start = h.cwiseProduct(normal - along - Vec3::UnitZ());
        const Vec3 end = h.cwiseProduct(normal + along - Vec3::UnitZ());
        const Vec3 up = height_m * Vec3::UnitZ();
        builder.polygon_of({start, end, end + up, start + up});
    }
    return builder.mesh;
}

Mesh cylinder(const Opening& opening) {
    const auto [u, v, w] = axes(opening.axis);
    const Vec3 half_axis = 0.5 * opening.size_m.cwiseProduct(w);
    MeshBuilder builder;
    std::vector<std::uint32_t> low;
    std::vector<std::uint32_t> high;
    for (const Vec3& corner : ellipse_corners(opening)) {
        low.push_back(builder.vertex(corner - half_axis));
        high.push_back(builder.vertex(corner + half_axis));
    }
    builder.polygon({low.rbegin(), low.rend()});
    builder.polygon(high);
    for (std::uint32_t i = 0; i < segments; ++i) {
        const std::uint32_t next = (i + 1) % segments;
        builder.polygon({low[i], low[next], high[next], high[i]});
    }
    return builder.mesh;
}

double surface_m2(const Mesh& mesh) {
    double area_m2 = 0.0;
    for (const auto& [a, b, c] : mesh.triangles) {
        const Vec3 edge = mesh.vertices[b] - mesh.vertices[a];
        area_m2 += 0.5 * edge.cross(mesh.vertices[c] - mesh.vertices[a]).norm();
    }
    return area_m2;
}

Mesh ellipsoid(const Opening& opening) {
    MeshBuilder builder;
    const auto point = [](std::uint32_t ring, std::uint32_t segment) {
        const double theta = pi * ring / rings;
        const double phi = 2.0 * pi * segment / sphere_segments;
        return Vec3(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                    -std::cos(theta));
    };
    const std::uint32_t bottom = builder.vertex(-Vec3::UnitZ());
    for (std::uint32_t ring = 1; ring < rings; ++ring) {
        for (std::uint32_t i = 0; i < sphere_segments; ++i) builder.vertex(point(ring, i));
    }
    const std::uint32_t top = builder.vertex(Vec3::UnitZ());
    const auto id = [&](std::uint32_t ring, std::uint32_t i) {
        return 1 + (ring - 1) * sphere_segments + i % sphere_segments;
    };
    for (std::uint32_t i = 0; i < sphere_segments; ++i) {
        builder.polygon({bottom, id(1, i + 1), id(1, i)});
        for (std::uint32_t ring = 1; ring + 1 < rings; ++ring) {
            builder.polygon({id(ring, i), id(ring, i + 1), id(ring + 1, i + 1), id(ring + 1, i)});
        }
        builder.polygon({id(rings - 1, i), id(rings - 1, i + 1), top});
    }
    // Mean projected area of a convex body is a quarter of its surface (Cauchy): keep that.
    const double scale = std::sqrt(4.0 * pi / surface_m2(builder.mesh));
    for (Vec3& vertex : builder.mesh.vertices) {
        vertex = 0.5 * scale * opening.size_m.cwiseProduct(vertex);
    }
    return builder.mesh;
}

}  // namespace

std::string Opening::description() const {
    const std::string size =
        fmt::format("{:.4g} x {:.4g} x {:.4g} m", size_m.x(), size_m.y(), size_m.z());
    const bool horizontal = axis != Axis::z;
    const char* along = axis == Axis::x ? "C0" : "C90";
    const auto flat = [&](const char* shape) {
        if (horizontal) return fmt::format("vertical {} facing {}, {}", shape, along, size);
        return fmt::format("{} {:.4g} x {:.4g} m", shape, size_m.x(), size_m.y());
    };
    switch (kind) {
        case Kind::point:
            return "point";
        case Kind::rectangle:
            return flat("rectangle");
        case Kind::ellipse: {
            if (!horizontal && size_m.x() == size_m.y()) {
                return fmt::format("disk of diameter {:.4g} m", size_m.x());
            }
            return flat("ellipse");
        }
        case Kind::box: {
            std::string text = "box " + size + " with luminous sides";
            const auto& h = side_heights_m;
            if (h[0] != h[1] || h[1] != h[2] || h[2] != h[3]) {
                text += fmt::format(" of height {:.4g}, {:.4g}, {:.4g}, {:.4g} m (C0 to C270)",
                                    h[0], h[1], h[2], h[3]);
            }
            return text;
        }
        case Kind::cylinder:
            return horizontal ? fmt::format("horizontal cylinder along {}, {}", along, size)
                              : "vertical cylinder " + size;
        case Kind::ellipsoid: {
            const bool sphere = size_m.x() == size_m.y() && size_m.y() == size_m.z();
            if (sphere) return fmt::format("sphere of diameter {:.4g} m", size_m.x());
            return "ellipsoid " + size;
        }
    }
    return "";
}

std::optional<Mesh> opening_mesh(const Opening& opening) {
    switch (opening.kind) {
        case Opening::Kind::point:
            break;
        case Opening::Kind::rectangle:
            return sheet(rectangle_corners(opening), opening.axis);
        case Opening::Kind::ellipse:
            return sheet(ellipse_corners(opening), opening.axis);
        case Opening::Kind::box:
            return box(opening);
        case Opening::Kind::cylinder:
            return cylinder(opening);
        case Opening::Kind::ellipsoid:
            return ellipsoid(opening);
    }
    return std::nullopt;
}

}  // namespace lucerna::optics
