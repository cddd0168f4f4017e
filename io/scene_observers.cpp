#include "io/scene_observers.h"

#include <algorithm>
#include <cmath>

#include "io/scene_shapes.h"

namespace lucerna::io {
namespace {

using namespace optics;

constexpr std::uint64_t most_pixels_per_side = 1u << 15;
constexpr std::uint64_t most_pixels = 1u << 27;
constexpr double most_grid_points = 1e6;

struct Resolution {
    int width = 1, height = 1;
};

Resolution read_resolution(const YamlCursor& cursor) {
    const auto entries = cursor.list();
    if (entries.size() != 2) {
        if (cursor.is_sequence()) cursor.complain("expected width and height such as [640, 480]");
        return {};
    }
    const auto width = read_count(entries[0], 1, most_pixels_per_side);
    const auto height = read_count(entries[1], 1, most_pixels_per_side);
    if (width * height > most_pixels)
        cursor.complain(fmt::format("has more than {} pixels", most_pixels));
    return {static_cast<int>(width), static_cast<int>(height)};
}

/// The key `up` of the camera, or of the scene.
Vec3 read_up(const SceneContext& context, YamlMap& map) {
    if (const YamlCursor up = map.optional("up")) return read_direction(up);
    if (context.up) return *context.up;
    map.cursor().complain(
        "the key 'up' is missing, here or for the whole scene; expected an axis such as z");
    return Vec3::Constant(std::nan(""));
}

void read_camera(SceneContext& context, UniqueNames& names, const YamlCursor& entry) {
    YamlMap map(entry);
    Camera camera;
    camera.name = names.read(map);
    const auto type = map.required("type", "'perspective'").choice({"perspective"});
    camera.from = read_lengths(map.required("from", "a position"));
    const YamlCursor to = map.required("to", "the position that it looks at");
    camera.to = read_lengths(to);
    camera.up = read_up(context, map);
    const YamlCursor fov = map.required("fov", "the horizontal angle of view, such as 60 deg");
    camera.horizontal_fov_rad = read_value(fov, dimension::angle, Accept::positive);
    if (camera.horizontal_fov_rad >= pi) fov.complain("must be less than 180 deg");
    const Resolution resolution =
        read_resolution(map.required("resolution", "width and height such as [640, 480]"));
    camera.width = resolution.width;
    camera.height = resolution.height;
    if (type) map.no_other_keys();

    const Vec3 view = camera.to - camera.from;
    if (view.norm() == 0.0)
        to.complain("must differ from 'from'");
    else if (view.cross(camera.up).norm() < 1e-9 * view.norm())
        entry.complain("looks along its 'up' direction");
    context.scene.parts.observers.emplace_back(std::move(camera));
}

void read_illuminance(SceneContext& context, YamlMap& map, std::string name) {
    IlluminancePoints points;
    points.name = std::move(name);
    const auto form = map.exactly_one({"position", "positions"});
    if (form.key == "position") points.positions.push_back(read_lengths(form.value));
    if (form.key == "positions") {
        for (const YamlCursor& entry : form.value.list())
            points.positions.push_back(read_lengths(entry));
        if (form.value.is_sequence() && points.positions.empty())
            form.value.complain("expected at least one position");
    }
    points.normal = read_direction(map.required("normal", "the direction that the points face"));
    context.scene.parts.observers.emplace_back(std::move(points));
}

struct GridCounts {
    double columns, rows;
};

GridCounts read_counts(YamlMap& map, const Rectangle& area) {
    const double u_m = area.edge_u.norm(), v_m = area.edge_v.norm();
    const auto form = map.exactly_one({"spacing", "columns"});
    if (form.key == "columns") {
        const auto most = static_cast<std::uint64_t>(most_grid_points);
        const auto columns = read_count(form.value, 1, most);
        const auto rows = read_count(map.required("rows", "a whole number"), 1, most);
        return {static_cast<double>(columns), static_cast<double>(rows)};
    }
    if (form.key.empty()) return {1.0, 1.0};
    const bool by_standard = form.value.is_scalar() && form.value.word() == "auto";
    const double spacing_m = by_standard
                                 ? en12464_spacing_m(u_m, v_m)
                                 : read_value(form.value, dimension::length, Accept::positive);
    // A side that is a multiple of the spacing must not get one column more by rounding.
    return {std::max(1.0, std::ceil(u_m / spacing_m - 1e-9)),
            std::max(1.0, std::ceil(v_m / spacing_m - 1e-9))};
}

void read_illuminance_grid(SceneContext& context, YamlMap& map, std::string name) {
    IlluminancePoints points;
    points.name = std::move(name);
    const Rectangle area = read_rectangle(map);
    // A rectangle by its centre has a normal already; one by its edges could face either way.
    if (map.has("center"))
        points.normal = read_direction(map.optional("normal"));
    else
        points.normal =
            read_direction(map.required("normal", "the direction that the points face"));
    const GridCounts counts = read_counts(map, area);
    if (counts.columns * counts.rows > most_grid_points) {
        map.cursor().complain(fmt::format("has more than {} points", most_grid_points));
        return;
    }
    if (!std::isfinite(counts.columns * counts.rows)) return;
    points.columns = static_cast<int>(counts.columns);
    points.rows = static_cast<int>(counts.rows);
    for (int row = 0; row < points.rows; ++row)
        for (int column = 0; column < points.columns; ++column)
            points.positions.push_back(area.corner + (column + 0.5) / points.columns * area.edge_u +
                                       (row + 0.5) / points.rows * area.edge_v);
    context.scene.parts.observers.emplace_back(std::move(points));
}

void read_luminance_meter(SceneContext& context, YamlMap& map, std::string name) {
    LuminanceMeter meter;
    meter.name = std::move(name);
    meter.position = read_lengths(map.required("position", "a position"));
    const auto aim = map.exactly_one({"target", "direction"});
    meter.direction = Vec3::Constant(std::nan(""));
    if (aim.key == "direction") meter.direction = read_direction(aim.value);
    if (aim.key == "target") {
        const Vec3 view = read_lengths(aim.value) - meter.position;
        if (view.norm() == 0.0) aim.value.complain("must differ from 'position'");
        meter.direction = view.normalized();
    }
    const YamlCursor acceptance =
        map.required("acceptance", "the full angle of the cone, such as 1 deg");
    meter.acceptance_half_angle_rad =
        0.5 * read_value(acceptance, dimension::angle, Accept::positive);
    if (meter.acceptance_half_angle_rad > 0.5 * pi)
        acceptance.complain("must be at most 180 deg, from edge to edge of the cone");
    context.scene.parts.observers.emplace_back(std::move(meter));
}

}  // namespace

double en12464_spacing_m(double side_m, double other_side_m) {
    const auto [shorter_m, longer_m] = std::minmax(side_m, other_side_m);
    const double d_m = longer_m >= 2.0 * shorter_m ? shorter_m : longer_m;
    return std::min(10.0, 0.2 * std::pow(5.0, std::log10(d_m)));
}

void read_cameras(SceneContext& context, const YamlCursor& section) {
    UniqueNames names;
    for (const YamlCursor& entry : section.list()) read_camera(context, names, entry);
}

void read_sensors(SceneContext& context, const SceneObjects& objects, const YamlCursor& section) {
    UniqueNames names;
    for (const YamlCursor& entry : section.list()) {
        YamlMap map(entry);
        const std::string name = names.read(map);
        const auto type =
            map.required("type", "the type of the sensor")
                .choice({"illuminance", "illuminance_grid", "luminance_meter", "flux"});
        if (!type) continue;
        if (*type == "illuminance") read_illuminance(context, map, name);
        if (*type == "illuminance_grid") read_illuminance_grid(context, map, name);
        if (*type == "luminance_meter") read_luminance_meter(context, map, name);
        if (*type == "flux") {
            const auto object = objects.find(map.required("on", "the name of an object"));
            if (object) context.scene.parts.receivers.push_back({name, *object});
        }
        map.no_other_keys();
    }
}

}  // namespace lucerna::io
