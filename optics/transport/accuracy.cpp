#include "optics/transport/accuracy.h"

#include <algorithm>

namespace lucerna::optics {

namespace {

constexpr int looks_in_a_row = 2;

}  // namespace

StopRule::StopRule(const SceneParts& parts, Settings limits, std::uint32_t phases_done)
    : parts_(parts), limits_(std::move(limits)) {
    const auto is_camera = [](const Observer& o) { return std::holds_alternative<Camera>(o); };
    const auto& observers = parts.observers;
    if (std::any_of(observers.begin(), observers.end(), is_camera)) {
        image_accuracy_ = limits_.image_accuracy;
    }
    const bool has_sensors =
        !parts.receivers.empty() || !std::all_of(observers.begin(), observers.end(), is_camera);
    sensors_asked_ = has_sensors && (limits_.sensor_accuracy || !limits_.sensor_targets.empty());
    while (next_look_ <= phases_done) next_look();
}

Furthest StopRule::furthest(const RunState& state) const {
    Furthest furthest;
    const auto consider = [&](Furthest other) {
        if (std::isnan(other.excess)) other.excess = infinity;  // nothing is known yet
        if (other.excess > furthest.excess) furthest = std::move(other);
    };
    if (image_accuracy_) consider({{}, state.delta / *image_accuracy_});
    if (sensors_asked_) {
        consider(state.readings.furthest_sensor(parts_, limits_));
        consider(state.furthest_receiver(parts_, limits_));
    }
    return furthest;
}

std::string StopRule::check(const RunState& state) {
    const bool last_phase = limits_.max_phases && state.phases >= *limits_.max_phases;
    const bool last_moment = limits_.time_limit_s && state.wall_s >= *limits_.time_limit_s;
    const bool last = last_phase || last_moment;
    if (asked() && (state.phases >= next_look_ || (last && state.phases >= 2))) {
        if (state.phases >= next_look_) next_look();
        const bool reached = furthest(state).excess <= 1.0;
        looks_reached_ = reached ? looks_reached_ + 1 : 0;
        // A limit that was set beforehand is no lucky moment.
        reached_ = looks_reached_ >= (last ? 1 : looks_in_a_row);
        if (reached_) return "accuracy";
    }
    if (last_phase) return "phases";
    if (last_moment) return "time limit";
    return {};
}

std::optional<double> StopRule::left_s(const RunState& state, const Furthest& furthest) const {
    std::optional<double> left;
    if (asked()) {
        const double ratio = furthest.excess;
        if (std::isfinite(ratio)) left = state.wall_s * std::max(0.0, ratio * ratio - 1.0);
    }
    if (limits_.time_limit_s) {
        const double rest = std::max(0.0, *limits_.time_limit_s - state.wall_s);
        left = left ? std::min(*left, rest) : rest;
    }
    return left;
}

}  // namespace lucerna::optics
