// What the cases after CIE 171:2006 share.
#pragma once

#include <fmt/format.h>

#include "validation/cases/panel_room.h"
#include "validation/truth/polygon_light.h"

namespace lucerna::validation {

inline std::vector<Vec3> polygon_of(const optics::Rectangle& r) {
    return truth::corners(r.corner, r.edge_u, r.edge_v);
}

// Collects points with their illuminances.
struct Points {
    SceneBuilder& scene;
    std::vector<Check> checks{};

    void add(const std::string& name, const Vec3& x, const Vec3& normal, double illuminance,
             std::optional<SweepPoint> sweep = std::nullopt) {
        checks.push_back({name, "illuminance", "lx", illuminance, 0.0, sensor(checks.size()), 0.015,
                          std::move(sweep)});
        scene.points({x}, normal);
    }
};

/// Daylight through openings, and light through panes: 5.4, 5.5 and 5.9 to 5.14.
std::vector<Case> cie171_daylight_cases();

}  // namespace lucerna::validation
