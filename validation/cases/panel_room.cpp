#include "validation/cases/panel_room.h"

#include <fmt/format.h>

#include <optional>

namespace lucerna::validation {
namespace {

Vec3 inward_normal(const truth::Panel& panel) {
    return (panel.plane_m == 0.0 ? 1.0 : -1.0) * Vec3::Unit(panel.axis);
}

constexpr const char* by_radiosity =
    "radiosity integral equation, Galerkin with exchange factors in closed form "
    "(Howell's catalogue, C-13 and C-15), extrapolated";

// Solutions of one room, and what they know of a functional.
class RoomTruth {
public:
    explicit RoomTruth(const std::vector<NamedPanel>& panels) {
        std::vector<truth::Panel> plain;
        for (const NamedPanel& own : panels) plain.push_back(own.panel);
        for (const int cells : {4, 6, 8, 12}) rooms_.emplace_back(plain, cells);
    }

    template <typename Functional>
    Check check(const std::string& name, const char* quantity, const char* unit, Read read,
                const Functional& functional) const {
        const double value = extrapolated(rooms_[1], rooms_[3], functional);
        // In narrow rooms cells are as wide as what they ought to tell apart.
        const double change = std::abs(value - extrapolated(rooms_[0], rooms_[2], functional));
        const double error = std::max(radiosity_error * value, change);
        return {name, quantity, unit, value, error, std::move(read), 0.015};
    }

private:
    std::vector<truth::RoomRadiosity> rooms_;
};

// Nothing where the panel is left out.
std::optional<optics::ObjectId> add_panel(SceneBuilder& scene, const NamedPanel& named) {
    const truth::Panel& panel = named.panel;
    if (panel.reflectance == 0.0) return std::nullopt;
    const optics::ObjectId wall =
        scene.object(named.name, rectangle(panel), scene.diffuse(panel.reflectance));
    if (panel.emitted_luminance > 0.0) scene.area_light(wall, panel.emitted_luminance);
    return wall;
}

}  // namespace

optics::Rectangle rectangle(const truth::Panel& panel) {
    const int u = (panel.axis + 1) % 3;
    const int v = (panel.axis + 2) % 3;
    Vec3 corner = Vec3::Zero();
    corner[panel.axis] = panel.plane_m;
    corner[u] = panel.span_u_m[0];
    corner[v] = panel.span_v_m[0];
    const Vec3 edge_u = (panel.span_u_m[1] - panel.span_u_m[0]) * Vec3::Unit(u);
    const Vec3 edge_v = (panel.span_v_m[1] - panel.span_v_m[0]) * Vec3::Unit(v);
    if (inward_normal(panel)[panel.axis] > 0.0) return {corner, edge_u, edge_v};
    return {corner, edge_v, edge_u};
}

double area_m2(const truth::Panel& panel) {
    return (panel.span_u_m[1] - panel.span_u_m[0]) * (panel.span_v_m[1] - panel.span_v_m[0]);
}

Case room_case(const std::string& id, const std::string& title,
               const std::vector<NamedPanel>& panels, const std::vector<WallPoint>& points,
               const optics::Settings& settings) {
    const RoomTruth truth(panels);
    SceneBuilder scene;
    std::vector<Check> checks;
    const auto check = [&](const std::string& name, Read read, const auto& functional) {
        checks.push_back(truth.check(name, "illuminance", "lx", std::move(read), functional));
    };
    for (const WallPoint& point : points) {
        check(point.name, sensor(checks.size()), [&](const truth::RoomRadiosity& room) {
            return room.illuminance(point.position, point.normal);
        });
        scene.points({point.position}, point.normal);
    }
    std::size_t next = points.size();
    for (std::size_t i = 0; i < panels.size(); ++i) {
        const std::optional<optics::ObjectId> wall = add_panel(scene, panels[i]);
        if (!wall || !panels[i].mean_is_checked) continue;
        scene.receiver(*wall);
        check(fmt::format("mean of {}", panels[i].name),
              scaled(sensor(next), 1.0 / area_m2(panels[i].panel)),
              [&](const truth::RoomRadiosity& room) { return room.mean_illuminance(i); });
        next += 2;  // front and back
    }
    return {id, title, by_radiosity, scene.parts, settings, checks};
}

Case spot_case(const std::string& id, const std::string& title,
               const std::vector<NamedPanel>& panels, const std::vector<WallSpot>& spots,
               const optics::Settings& settings) {
    const RoomTruth truth(panels);
    SceneBuilder scene;
    std::vector<Check> checks;
    for (const NamedPanel& panel : panels) add_panel(scene, panel);
    for (const WallSpot& spot : spots) {
        checks.push_back(
            truth.check(spot.name, "luminance", "cd/m2", sensor(checks.size()),
                        [&](const truth::RoomRadiosity& room) {
                            return room.cone_luminance(
                                spot.panel, inward_normal(panels[spot.panel].panel), spot.position,
                                (spot.target - spot.position).normalized(), spot.half_angle_rad);
                        }));
        scene.meter(spot.position, spot.target, spot.half_angle_rad);
    }
    return {id, title, by_radiosity, scene.parts, settings, checks};
}

void add_sky(SceneBuilder& scene, const optics::Rectangle& opening, double luminance) {
    const Vec3 u = opening.edge_u.normalized();
    const Vec3 v = opening.edge_v.normalized();
    const Vec3 out = -u.cross(v);
    const double overhang_m = 0.1;
    const double depth_m = 0.3;
    const Vec3 corner = opening.corner - overhang_m * (u + v);
    const Vec3 eu = opening.edge_u + 2.0 * overhang_m * u;
    const Vec3 ev = opening.edge_v + 2.0 * overhang_m * v;
    const Vec3 eo = depth_m * out;
    const optics::BsdfId black = scene.black();
    using optics::Rectangle;
    const std::array<Rectangle, 5> faces{Rectangle{corner + eo, eu, ev},  // toward the room
                                         Rectangle{corner, eo, ev},  // the sides, toward each other
                                         Rectangle{corner + eu, ev, eo}, Rectangle{corner, eu, eo},
                                         Rectangle{corner + ev, eo, eu}};
    for (const Rectangle& face : faces)
        scene.area_light(scene.object("sky", face, black), luminance);
}

}  // namespace lucerna::validation
