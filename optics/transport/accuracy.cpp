#include "optics/transport/accuracy.h"

#include <algorithm>

namespace lucerna::optics {

StopRule::StopRule(const Settings& settings, bool has_cameras, bool has_sensors)
    : image_accuracy_(has_cameras ? settings.image_accuracy : std::nullopt),
      sensor_accuracy_(has_sensors ? settings.sensor_accuracy : std::nullopt),
      time_limit_s_(settings.time_limit_s),
      max_phases_(settings.max_phases) {
    asked_ = image_accuracy_ || sensor_accuracy_;
}

std::string StopRule::check(std::uint32_t phases_done, const Readings& readings,
                            double worst_receiver, double elapsed_s) {
    const bool last = (max_phases_ && phases_done >= *max_phases_) ||
                      (time_limit_s_ && elapsed_s >= *time_limit_s_);
    if (asked_ && (phases_done >= next_look_ || (last && phases_done >= 2))) {
        if (phases_done >= next_look_) next_look_ = std::max(next_look_ + 1, next_look_ * 6 / 5);
        const double sensors = std::max(readings.worst_sensor_error(), worst_receiver);
        reached_ = (!image_accuracy_ || readings.delta() <= *image_accuracy_) &&
                   (!sensor_accuracy_ || sensors <= *sensor_accuracy_);
        if (reached_) return "accuracy";
    }
    if (max_phases_ && phases_done >= *max_phases_) return "phases";
    if (time_limit_s_ && elapsed_s >= *time_limit_s_) return "time limit";
    return {};
}

std::optional<double> StopRule::left_s(const Readings& readings, double elapsed_s) const {
    std::optional<double> left;
    if (image_accuracy_) {
        const double ratio = readings.delta() / *image_accuracy_;
        if (std::isfinite(ratio)) left = elapsed_s * std::max(0.0, ratio * ratio - 1.0);
    }
    if (time_limit_s_) {
        const double rest = std::max(0.0, *time_limit_s_ - elapsed_s);
        left = left ? std::min(*left, rest) : rest;
    }
    return left;
}

}  // namespace lucerna::optics
