// What the phases of a run add up to: enough to go on with it, and to join it with other runs.
#pragma once

#include <cmath>

#include "optics/transport/phase_trace.h"

namespace lucerna::optics {

struct RunState {
    /// Of a run without any phase yet.
    RunState(const SceneParts& parts, const Settings& settings);

    /// Adds a phase to the estimates and empties its trace.
    /// @param lanes  phases that are traced at the same time
    void fold(const SceneParts& parts, const Phase& phase, PhaseTrace& trace, int threads,
              int lanes);
    /// Joins the phases of a run of the same scene and settings but for the seed. Their order
    /// matters for the last bits of the sums.
    void merge(const RunState& other);

    Furthest furthest_receiver(const SceneParts& parts, const Settings& targets) const;
    Result result(const SceneParts& parts) const;

    Settings settings;                 ///< of the run; all of its phases rest on them
    std::vector<std::uint64_t> seeds;  ///< of the runs that were joined
    std::uint32_t phases = 0;
    double wall_s = 0.0;
    std::string stopped_by;
    bool accuracy_reached = true;
    Furthest furthest{};  ///< where the accuracy was not reached; not saved
    std::vector<std::string> warnings;

    Readings readings;
    double delta = std::nan("");     ///< of docs/method.md eq. 6, from 2 phases on; not saved
    ForwardTally tally;              ///< of the rays that the flux balance is taken from
    std::uint64_t tally_rays = 0;    ///< their number
    std::vector<Estimate> received;  ///< per receiver: front, back [lm]
    RayCounts counts;
    std::uint64_t forward_map_bytes = 0, backward_map_bytes = 0;  ///< largest seen

    /// Saves to an archive, or loads in a state of the same scene.
    template <typename Archive>
    void serialize(Archive& archive) {
        archive(seeds, phases, wall_s, stopped_by, accuracy_reached, warnings, readings, tally,
                tally_rays, received, counts, forward_map_bytes, backward_map_bytes);
    }
};

}  // namespace lucerna::optics
