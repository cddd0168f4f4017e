// Random numbers of the paths of one pixel or sensor point: their first pairs fill the unit square
// evenly over all of these paths, so that the mean over them has less noise.
#pragma once

#include <array>
#include <cstdint>

#include "core/random.h"

namespace lucerna {

/// Which of several paths of the same origin a stream belongs to.
struct Stratum {
    std::uint32_t set = 0;    ///< random key that all paths of the origin share in a phase
    std::uint32_t index = 0;  ///< of the path, below `count`
    std::uint32_t count = 1;
};

/// Random numbers of one of these paths.
/// Each number alone is uniform in [0, 1), and pairs of different dimensions are independent: the
/// mean over paths stays unbiased, and phases with different keys stay independent of each other.
class StratifiedStream : public RandomStream {
public:
    StratifiedStream(const RandomStream& random, const Stratum& stratum)
        : RandomStream(random), stratum_(stratum) {}

    /// The next pair. The k-th pairs of all paths are a (0, 2)-sequence in base 2, scrambled after
    /// Owen, in random order; only the first few pairs of a path are, the later ones are random.
    std::array<double, 2> pair();

private:
    Stratum stratum_;
    std::uint32_t pairs_ = 0;
};

}  // namespace lucerna
