#include "optics/transport/accuracy.h"

#include <algorithm>

namespace lucerna::optics {

namespace {

constexpr int looks_in_a_row = 2;

}  // namespace

double excess(const SensorTarget& target, double value, double expanded_uncertainty) {
    if (!(target.relative > 0.0 || target.absolute > 0.0)) return 0.0;
    // What is exactly known, such as darkness, is known well enough.
    return expanded_uncertainty > 0.0 ? expanded_uncertainty / target.wanted(value) : 0.0;
}

StopRule::StopRule(const Settings& settings, bool has_cameras, bool has_sensors)
    : image_accuracy_(has_cameras ? settings.image_accuracy : std::nullopt),
      time_limit_s_(settings.time_limit_s),
      max_phases_(settings.max_phases),
      sensors_asked_(has_sensors &&
                     (settings.sensor_accuracy || !settings.sensor_targets.empty())) {}

double StopRule::excess_now(const Readings& readings, double worst_receiver) const {
    double worst = 0.0;
    if (image_accuracy_) worst = readings.delta() / *image_accuracy_;
    if (sensors_asked_) worst = std::max({worst, readings.worst_sensor(), worst_receiver});
    return worst;
}

std::string StopRule::check(std::uint32_t phases_done, const Readings& readings,
                            double worst_receiver, double elapsed_s) {
    const bool last_phase = max_phases_ && phases_done >= *max_phases_;
    const bool last_moment = time_limit_s_ && elapsed_s >= *time_limit_s_;
    const bool last = last_phase || last_moment;
    if (asked() && (phases_done >= next_look_ || (last && phases_done >= 2))) {
        if (phases_done >= next_look_) next_look_ = std::max(next_look_ + 1, next_look_ * 6 / 5);
        const bool reached = excess_now(readings, worst_receiver) <= 1.0;
        looks_reached_ = reached ? looks_reached_ + 1 : 0;
        // A limit that was set beforehand is no lucky moment.
        reached_ = looks_reached_ >= (last ? 1 : looks_in_a_row);
        if (reached_) return "accuracy";
    }
    if (last_phase) return "phases";
    if (last_moment) return "time limit";
    return {};
}

std::optional<double> StopRule::left_s(const Readings& readings, double worst_receiver,
                                       double elapsed_s) const {
    std::optional<double> left;
    if (asked()) {
        const double ratio = excess_now(readings, worst_receiver);
        if (std::isfinite(ratio)) left = elapsed_s * std::max(0.0, ratio * ratio - 1.0);
    }
    if (time_limit_s_) {
        const double rest = std::max(0.0, *time_limit_s_ - elapsed_s);
        left = left ? std::min(*left, rest) : rest;
    }
    return left;
}

}  // namespace lucerna::optics
