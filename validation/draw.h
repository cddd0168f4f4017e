// Parameters of cases that nobody chose.
#pragma once

#include <cmath>
#include <cstdint>

#include "core/random.h"
#include "core/vector.h"

namespace lucerna::validation {

/// Successive parameters of a drawn case, a function of (seed, number) alone.
class Draw {
public:
    Draw(std::uint64_t seed, std::uint32_t number)
        : random_(seed, number, RandomPurpose::test, 0) {}

    /// Evenly in [low, high).
    double between(double low, double high) { return low + (high - low) * random_.uniform(); }
    /// Evenly in the logarithm.
    double log_between(double low, double high) {
        return std::exp(between(std::log(low), std::log(high)));
    }
    /// True with this probability.
    bool happens(double probability) { return random_.uniform() < probability; }
    /// A unit vector at most that far from the axis, evenly by solid angle.
    Vec3 direction(const Vec3& axis, double max_angle_rad) {
        const double cosine = between(std::cos(max_angle_rad), 1.0);
        const double azimuth = between(0.0, 2.0 * pi);
        const double sine = std::sqrt(1.0 - cosine * cosine);
        const Vec3 u = axis.unitOrthogonal();
        return cosine * axis + sine * (std::cos(azimuth) * u + std::sin(azimuth) * axis.cross(u));
    }

private:
    RandomStream random_;
};

/// The first of what `draw` returns that `fits`.
template <typename Drawing, typename Condition>
auto first_that(Condition&& fits, Drawing&& draw) {
    for (;;) {
        auto drawn = draw();
        if (fits(drawn)) return drawn;
    }
}

}  // namespace lucerna::validation
