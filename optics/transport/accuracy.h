// When a simulation may stop.
#pragma once

#include "optics/transport/run_state.h"

namespace lucerna::optics {

/// Decides after each phase whether to go on. Accuracy is looked at only after 16, 19, 22, 26, ...
/// phases, each step a fifth longer, and has to be reached at two looks in a row: looking after
/// every phase would stop at lucky moments and make the stated error too small (THEORY, stop rule).
class StopRule {
public:
    /// @param limits  accuracies, time limit and number of phases; the time that the run has taken
    ///     before is part of the limit.
    /// @param phases_done  after which the looks begin.
    StopRule(const SceneParts& parts, Settings limits, std::uint32_t phases_done);

    /// Empty while the simulation goes on, else what stopped it.
    std::string check(const RunState& state);

    bool accuracy_reached() const { return reached_ || !asked(); }
    /// Of all that is asked for.
    Furthest furthest(const RunState& state) const;
    /// Wall time until that one is reached if errors fall with the square root of time.
    std::optional<double> left_s(const RunState& state, const Furthest& furthest) const;
    /// Noise of images to stop at, if there are any and it is asked for.
    std::optional<double> image_accuracy() const { return image_accuracy_; }

private:
    bool asked() const { return image_accuracy_ || sensors_asked_; }
    void next_look() { next_look_ = std::max(next_look_ + 1, next_look_ * 6 / 5); }

    const SceneParts& parts_;
    Settings limits_;
    std::optional<double> image_accuracy_;
    bool sensors_asked_ = false;
    std::uint32_t next_look_ = 16;
    int looks_reached_ = 0;  // in a row
    bool reached_ = false;
};

}  // namespace lucerna::optics
