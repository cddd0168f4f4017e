// How the rays of a forward trace leave the lights.
#pragma once

#include "core/stratified.h"
#include "optics/transport/emission_guide.h"
#include "optics/transport/phase.h"

namespace lucerna::optics {

/// The departures of the rays of one trace. Each ray is an unbiased sample of the lights' flux, and
/// so is the mean over them.
class Emission {
public:
    /// Rays that are independent of each other, in proportion to flux.
    Emission(const Phase& phase, RandomPurpose purpose) : phase_(phase), purpose_(purpose) {}
    /// Independent rays where the guide, unless empty, sends them.
    Emission(const Phase& phase, RandomPurpose purpose, const EmissionGuide& guide)
        : phase_(phase), purpose_(purpose), guide_(guide.empty() ? nullptr : &guide) {}
    /// A number of rays where the guide, unless empty, sends them, spread evenly: each light has
    /// its number of rays, and their numbers are (0, 2)-sequences scrambled anew in each phase.
    Emission(const Phase& phase, RandomPurpose purpose, const EmissionGuide& guide,
             std::uint32_t rays);

    /// The random numbers of a ray, which go on behind its departure.
    RandomStream random(std::uint32_t index) const {
        return {phase_.seed, phase_.number, purpose_, index};
    }
    /// Whether the rays have common heroes: those whose photons backward rays gather.
    bool common_heroes() const { return purpose_ == RandomPurpose::caustic; }
    /// Whether a guide sends them: they carry unequal flux.
    bool guided() const { return guide_ != nullptr; }
    Departure depart(std::uint32_t index, RandomStream& random) const;

private:
    const Phase& phase_;
    RandomPurpose purpose_;
    const EmissionGuide* guide_ = nullptr;
    struct Share {
        std::uint32_t first, end;  // rays of the light
        std::uint32_t set;         // key of their sequences
    };
    std::vector<Share> shares_;  // of each light; empty for independent rays
};

}  // namespace lucerna::optics
