// Rooms of axis-aligned diffuse panels with their truth by radiosity, and skies behind openings.
#pragma once

#include "validation/case.h"
#include "validation/scene_builder.h"
#include "validation/truth/room_radiosity.h"

namespace lucerna::validation {

/// Bound of the relative error of the extrapolated truth: against solutions with 8 and 16 and with
/// 12 and 24 cells, for points and large panels (tests/validation/test_truths.cpp).
inline constexpr double radiosity_error = 3e-4;

struct NamedPanel {
    std::string name;
    truth::Panel panel;  ///< those at coordinate 0 face up the axis, all others down
    /// False for narrow panels beside bright ones, whose mean the truth knows less well.
    bool mean_is_checked = true;
};

/// A point just inside a panel, where a sensor sees what the panel sees.
struct WallPoint {
    std::string name;
    Vec3 position, normal;
};

/// What a luminance meter sees: a cone within one panel.
struct WallSpot {
    std::string name;
    std::size_t panel;
    Vec3 position, target;
    double half_angle_rad;
};

optics::Rectangle rectangle(const truth::Panel& panel);
double area_m2(const truth::Panel& panel);

/// The room as a case: illuminance at the points, and mean illuminance of each panel that reflects
/// anything and is to be checked, from the luminous flux on it. A panel of reflectance 0 is left
/// out of the scene: an opening. The truth is extrapolated from 6 and 12 cells per panel and edge,
/// its error at least what 4 and 8 cells change.
Case room_case(const std::string& id, const std::string& title,
               const std::vector<NamedPanel>& panels, const std::vector<WallPoint>& points,
               const optics::Settings& settings);

/// The same room, looked at by luminance meters.
Case spot_case(const std::string& id, const std::string& title,
               const std::vector<NamedPanel>& panels, const std::vector<WallSpot>& spots,
               const optics::Settings& settings);

/// A uniform sky behind a rectangular opening whose normal u x v points into the room: a black
/// luminous tray of five faces outside, wider than the opening, that fills the opening as seen from
/// every point within.
void add_sky(SceneBuilder& scene, const optics::Rectangle& opening, double luminance);

}  // namespace lucerna::validation
