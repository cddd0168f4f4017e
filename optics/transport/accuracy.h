// When a simulation may stop.
#pragma once

#include <chrono>

#include "optics/transport/readings.h"
#include "optics/transport/simulate.h"

namespace lucerna::optics {

/// Decides after each phase whether to go on. Accuracy is looked at only after 8, 10, 12, 15, ...
/// phases, each step a fifth longer: looking after every phase would stop at lucky moments and make
/// the stated error too small (THEORY, stop rule).
class StopRule {
public:
    StopRule(const Settings& settings, bool has_cameras, bool has_sensors);

    /// Empty while the simulation goes on, else what stopped it.
    std::string check(std::uint32_t phases_done, const Readings& readings, double worst_receiver,
                      double elapsed_s);

    bool accuracy_reached() const { return reached_ || !asked_; }
    /// Wall time until delta is reached if errors fall with the square root of time.
    std::optional<double> left_s(const Readings& readings, double elapsed_s) const;

private:
    std::optional<double> image_accuracy_, sensor_accuracy_, time_limit_s_;
    std::optional<std::uint32_t> max_phases_;
    std::uint32_t next_look_ = 8;
    bool asked_ = false;
    bool reached_ = false;
};

}  // namespace lucerna::optics
