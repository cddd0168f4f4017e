// When a simulation may stop.
#pragma once

#include <chrono>

#include "optics/transport/readings.h"
#include "optics/transport/simulate.h"

namespace lucerna::optics {

/// Coverage of the expanded uncertainty that targets are stated for.
inline constexpr double target_coverage = 0.95;

/// Expanded uncertainty over what is asked of a value: at most 1 if that is reached; 0 if nothing
/// is asked.
double excess(const SensorTarget& target, double value, double expanded_uncertainty);

/// Decides after each phase whether to go on. Accuracy is looked at only after 16, 19, 22, 26, ...
/// phases, each step a fifth longer, and has to be reached at two looks in a row: looking after
/// every phase would stop at lucky moments and make the stated error too small (THEORY, stop rule).
class StopRule {
public:
    StopRule(const Settings& settings, bool has_cameras, bool has_sensors);

    /// Empty while the simulation goes on, else what stopped it.
    /// @param worst_receiver  largest excess() among the receivers.
    std::string check(std::uint32_t phases_done, const Readings& readings, double worst_receiver,
                      double elapsed_s);

    bool accuracy_reached() const { return reached_ || !asked(); }
    /// Wall time until the accuracy is reached if errors fall with the square root of time.
    std::optional<double> left_s(const Readings& readings, double worst_receiver,
                                 double elapsed_s) const;

private:
    bool asked() const { return image_accuracy_ || sensors_asked_; }
    // Errors over what is asked for.
    double excess_now(const Readings& readings, double worst_receiver) const;

    std::optional<double> image_accuracy_, time_limit_s_;
    std::optional<std::uint32_t> max_phases_;
    bool sensors_asked_ = false;
    std::uint32_t next_look_ = 16;
    int looks_reached_ = 0;  // in a row
    bool reached_ = false;
};

}  // namespace lucerna::optics
