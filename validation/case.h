// A validation case: a scene, and what is known of it without the engine.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "optics/scene.h"
#include "optics/transport/settings.h"
#include "validation/reading.h"

namespace lucerna::validation {

/// Place of a check in a sweep over a parameter: those of one curve are drawn as one plot.
struct SweepPoint {
    std::string curve;  ///< "transmittance of a slab"
    std::string axis;   ///< "angle of incidence [deg]"
    double at;
};

/// One number that the engine must reproduce.
struct Check {
    std::string name;      ///< unique within the case: "desk, 1 m beside the axis"
    std::string quantity;  ///< term of CIE S 017, or "transmittance", "chromaticity" and the like
    std::string unit;
    double truth;
    double truth_error;  ///< bound of the truth's own error, same unit
    Read read;
    /// Largest U that leaves the check any power, in shares of |truth|.
    double detects_relative = 0.01;
    std::optional<SweepPoint> sweep = std::nullopt;
};

struct Case {
    std::string id;      ///< family and parameters: "slab/60-deg"
    std::string title;   ///< what is there, in a line
    std::string source;  ///< where the truth comes from: formula and page
    optics::SceneParts scene;
    optics::Settings settings;
    std::vector<Check> checks;
};

/// Flux of the lamps of cases that follow flux through glass.
inline constexpr double lamp_flux_lm = 1000.0;
/// Illuminance points stand this far before their wall.
inline constexpr double lift_m = 1e-4;

/// The engine's settings of a case: a fixed number of phases and of forward rays per phase and map.
inline optics::Settings effort(std::uint32_t phases, std::uint32_t forward_rays,
                               int samples_per_pixel = 1,
                               optics::Method method = optics::Method::combined) {
    optics::Settings settings;
    settings.method = method;
    settings.max_phases = phases;
    settings.forward_rays = forward_rays;
    settings.samples_per_pixel = samples_per_pixel;
    return settings;
}

}  // namespace lucerna::validation
