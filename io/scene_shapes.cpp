#include "io/scene_shapes.h"

#include <cmath>

#include "io/mesh_file.h"

namespace lucerna::io {
namespace {

using namespace optics;

/// Two lengths, such as the size of a rectangle.
Vec2 read_size(const YamlCursor& cursor) {
    Vec2 size = Vec2::Constant(std::nan(""));
    if (!cursor) return size;
    const auto entries = cursor.list();
    if (cursor.is_sequence() && entries.size() != 2)
        cursor.complain(fmt::format(
            "has {} entries; expected width and height such as [600 mm, 400 mm]", entries.size()));
    for (std::size_t i = 0; entries.size() == 2 && i < 2; ++i)
        size[static_cast<Eigen::Index>(i)] =
            read_value(entries[i], dimension::length, Accept::positive);
    return size;
}

/// Three lengths that are all positive.
Vec3 read_box_size(const YamlCursor& cursor) {
    const Vec3 size = read_lengths(cursor);
    if (size.minCoeff() <= 0.0) cursor.complain("the size of a box must be positive on all axes");
    return size;
}

Box read_box(YamlMap& map) {
    Box box{Placement::Identity(), Vec3::Constant(std::nan(""))};
    const auto form = map.exactly_one({"min", "center"});
    if (form.key == "min") {
        const Vec3 min = read_lengths(form.value);
        const YamlCursor max_cursor = map.required("max", "the opposite corner");
        box.size_m = read_lengths(max_cursor) - min;
        if (box.size_m.minCoeff() <= 0.0)
            max_cursor.complain("must be larger than 'min' on all axes");
        box.placement = Placement(Eigen::Translation3d(min));
    } else if (form.key == "center") {
        const Vec3 center = read_lengths(form.value);
        box.size_m = read_box_size(map.required("size", "three lengths"));
        box.placement = Placement(Eigen::Translation3d(center - 0.5 * box.size_m));
    }
    return box;
}

double read_radius(YamlMap& map) {
    return read_value(map.required("radius", "a length"), dimension::length, Accept::positive);
}

/// The inner radius of an annulus or a tube; 0 where it is absent.
double read_inner_radius(const YamlCursor& cursor, double radius_m) {
    if (!cursor) return 0.0;
    const double inner_m = read_value(cursor, dimension::length, Accept::positive);
    if (inner_m >= radius_m) cursor.complain("must be smaller than 'radius'");
    return inner_m;
}

struct Axis {
    Vec3 from, to;
};

Axis read_axis(YamlMap& map) {
    const Axis axis{read_lengths(map.required("from", "the centre of one end")),
                    read_lengths(map.required("to", "the centre of the other end"))};
    if ((axis.to - axis.from).norm() == 0.0)
        map.cursor().complain("'from' and 'to' are the same point");
    return axis;
}

Disk read_disk(YamlMap& map) {
    const Vec3 center = read_lengths(map.required("center", "a position"));
    const Vec3 normal = read_direction(map.required("normal", "a direction"));
    const double radius_m = read_radius(map);
    return {center, normal, radius_m, read_inner_radius(map.optional("inner_radius"), radius_m)};
}

Tube read_tube(YamlMap& map) {
    const Axis axis = read_axis(map);
    const double radius_m = read_radius(map);
    return {axis.from, axis.to, radius_m,
            read_inner_radius(map.required("inner_radius", "a length"), radius_m)};
}

std::optional<Shape> read_mesh(SceneContext& context, YamlMap& map) {
    const YamlCursor file = map.required("file", "an OBJ, PLY or STL file");
    const auto path = context.file(file);
    const auto unit = map.required("unit", "the unit of the file's coordinates, such as mm")
                          .choice({"m", "mm", "cm", "um", "in", "ft"});
    if (!path || !unit) return {};
    const std::map<std::string, double> metres{{"m", 1.0},   {"mm", 1e-3},   {"cm", 1e-2},
                                               {"um", 1e-6}, {"in", 0.0254}, {"ft", 0.3048}};
    auto& mesh = context.meshes[path->string() + '\n' + *unit];
    if (!mesh) {
        const auto read =
            context.attempt(file, [&] { return read_mesh_file(*path, metres.at(*unit)); });
        if (!read) return {};
        for (const std::string& warning : read->warnings) context.warn(file, warning);
        mesh = read->mesh;
    }
    return MeshInstance{mesh, Placement::Identity()};
}

Shape placed(const Shape& shape, const Placement& at) {
    const auto turn = [&](const Vec3& v) -> Vec3 { return at.linear() * v; };
    struct Mover {
        const Placement& at;
        decltype(turn)& turned;
        Shape operator()(const Rectangle& s) const {
            return Rectangle{at * s.corner, turned(s.edge_u), turned(s.edge_v)};
        }
        Shape operator()(const Box& s) const { return Box{at * s.placement, s.size_m}; }
        Shape operator()(const Disk& s) const {
            return Disk{at * s.centre, turned(s.normal), s.radius_m, s.inner_radius_m};
        }
        Shape operator()(const Sphere& s) const { return Sphere{at * s.centre, s.radius_m}; }
        Shape operator()(const Cylinder& s) const {
            return Cylinder{at * s.from, at * s.to, s.radius_m};
        }
        Shape operator()(const Tube& s) const {
            return Tube{at * s.from, at * s.to, s.radius_m, s.inner_radius_m};
        }
        Shape operator()(const MeshInstance& s) const {
            return MeshInstance{s.mesh, at * s.placement};
        }
    };
    return std::visit(Mover{at, turn}, shape);
}

}  // namespace

Placement read_placement(const YamlCursor& place) {
    Placement placement = Placement::Identity();
    if (!place) return placement;
    YamlMap map(place);
    const YamlCursor rotate = map.optional("rotate");
    const auto steps = rotate.is_sequence() ? rotate.list() : std::vector{rotate};
    for (const YamlCursor& step : steps) {
        if (!step) continue;
        YamlMap rotation(step);
        const Vec3 axis = read_direction(rotation.required("axis", "a direction"));
        const double angle_rad =
            read_value(rotation.required("angle", "an angle such as 20 deg"), dimension::angle);
        rotation.no_other_keys();
        placement = Eigen::AngleAxisd(angle_rad, axis) * placement;
    }
    if (const YamlCursor move = map.optional("move")) placement.pretranslate(read_lengths(move));
    map.no_other_keys();
    return placement;
}

Rectangle read_rectangle(YamlMap& map) {
    const Vec3 unknown = Vec3::Constant(std::nan(""));
    const auto form = map.exactly_one({"corner", "center"});
    if (form.key == "corner") {
        const Rectangle rectangle{read_lengths(form.value),
                                  read_lengths(map.required("edge_u", "three lengths")),
                                  read_lengths(map.required("edge_v", "three lengths"))};
        const double lengths = rectangle.edge_u.norm() * rectangle.edge_v.norm();
        if (lengths == 0.0) map.cursor().complain("an edge of the rectangle has no length");
        // A user may round coordinates; an angle that is off by more is a mistake.
        if (std::abs(rectangle.edge_u.dot(rectangle.edge_v)) > 1e-6 * lengths)
            map.cursor().complain("'edge_u' and 'edge_v' are not at right angles; use a mesh");
        return rectangle;
    }
    if (form.key.empty()) return {unknown, unknown, unknown};
    const Vec3 center = read_lengths(form.value);
    const Vec2 size = read_size(map.required("size", "width and height"));
    const Vec3 normal = read_direction(map.required("normal", "a direction"));
    const YamlCursor up_cursor = map.required("up", "the direction of the second side");
    const Vec3 up = read_direction(up_cursor);
    const Vec3 across = up.cross(normal);
    if (across.norm() < 1e-6) {
        up_cursor.complain("must not be along 'normal'");
        return {unknown, unknown, unknown};
    }
    const Vec3 edge_u = across.normalized() * size.x();
    const Vec3 edge_v = normal.cross(across.normalized()) * size.y();
    return {center - 0.5 * (edge_u + edge_v), edge_u, edge_v};
}

std::optional<Shape> read_shape(SceneContext& context, const YamlCursor& cursor,
                                const Placement& placement, const std::vector<std::string>& types) {
    if (!cursor) return {};
    YamlMap map(cursor);
    const std::vector<std::string> all{"rectangle", "box",  "disk", "sphere",
                                       "cylinder",  "tube", "mesh"};
    const auto type =
        map.required("type", "the type of the shape").choice(types.empty() ? all : types);
    if (!type) return {};
    const std::size_t complaints = context.diagnostics.list().size();
    std::optional<Shape> shape;
    if (*type == "rectangle") shape = read_rectangle(map);
    if (*type == "box") shape = read_box(map);
    if (*type == "disk") shape = read_disk(map);
    if (*type == "sphere") {
        const Vec3 center = read_lengths(map.required("center", "a position"));
        shape = Sphere{center, read_radius(map)};
    }
    if (*type == "cylinder") {
        const Axis axis = read_axis(map);
        shape = Cylinder{axis.from, axis.to, read_radius(map)};
    }
    if (*type == "tube") shape = read_tube(map);
    if (*type == "mesh") shape = read_mesh(context, map);
    map.no_other_keys();
    const bool complained = context.diagnostics.list().size() != complaints;
    if (!shape || complained || !placement.matrix().allFinite()) return {};
    const Shape in_scene = placed(*shape, placement);
    const double area = area_m2(in_scene);
    if (std::isfinite(area) && area > 0.0) return in_scene;
    cursor.complain("its surface has no finite area above zero");
    return {};
}

}  // namespace lucerna::io
