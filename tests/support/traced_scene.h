// A scene with all that a trace of its rays needs.
#pragma once

#include <utility>

#include "optics/transport/phase_trace.h"
#include "validation/scene_builder.h"

namespace lucerna::test {

/// The scene must have something that measures. What refers to it stays beside it.
struct TracedScene {
    explicit TracedScene(validation::SceneBuilder builder) : scene(std::move(builder)) {}
    TracedScene(const TracedScene&) = delete;
    TracedScene& operator=(const TracedScene&) = delete;

    validation::SceneBuilder scene;
    optics::Stage stage{scene.parts};
    optics::SensorPlanes planes{stage.parts(), stage.caster(), 0.1};
    optics::Settings settings;
    optics::Readings readings{scene.parts, settings};
    optics::TraceContext context{stage, planes, readings, optics::Scheduler::ordered, 1};
};

}  // namespace lucerna::test
