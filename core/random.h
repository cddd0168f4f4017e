// Counter-based random numbers: the value depends on (seed, phase, purpose, path, dimension) only,
// never on the thread that asks, so that any number of threads gives the same bits.
#pragma once

#include <array>
#include <cstdint>

namespace lucerna {

/// What a stream of random numbers is for; streams of different purposes are independent.
enum class RandomPurpose : std::uint32_t {
    backward,
    caustic,
    secondary,
    wavelengths,
    pilot,
    test,
    strata,
    indirect,
    masks,
    emission
};

/// Random numbers of one path, Philox4x32-10 (Salmon et al., SC'11) by Random123.
/// Successive calls walk through the dimensions of the path.
class RandomStream {
public:
    RandomStream(std::uint64_t seed, std::uint32_t phase, RandomPurpose purpose,
                 std::uint32_t path);

    /// Uniform in [0, 1), a multiple of 2^-32.
    double uniform() { return bits() * 0x1p-32; }

    /// 32 random bits.
    std::uint32_t bits() {
        if (next_ == 4) refill();
        return buffer_[next_++];
    }

private:
    void refill();

    std::array<std::uint32_t, 2> key_;
    std::array<std::uint32_t, 4> counter_;
    std::array<std::uint32_t, 4> buffer_;
    unsigned next_ = 4;
};

}  // namespace lucerna
