// Random points and directions from uniform numbers, each with its density.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/vector.h"

namespace lucerna {

/// Direction on the hemisphere around +z with density cos(theta) / pi per solid angle.
Vec3 sample_cosine_hemisphere(double u1, double u2);

/// Direction on the sphere with density 1 / (4 pi) per solid angle.
Vec3 sample_sphere(double u1, double u2);

/// Point in the unit disk with density 1 / pi per area (concentric map of Shirley and Chiu, 1997).
Vec2 sample_disk(double u1, double u2);
/// The two numbers from which sample_disk() makes a point of the unit disk.
Vec2 numbers_of_disk_sample(const Vec2& point);

/// Direction within a cone around +z of the given half angle, uniform per solid angle.
Vec3 sample_cone(double cos_half_angle, double u1, double u2);

/// Discrete distribution over indices in proportion to weights >= 0, not all zero.
class DiscreteDistribution {
public:
    DiscreteDistribution() = default;
    explicit DiscreteDistribution(std::span<const double> weights);

    /// Index for u in [0, 1); if `rest` is given, it receives a fresh uniform number left over from
    /// u.
    std::size_t sample(double u, double* rest = nullptr) const;
    double probability(std::size_t index) const;
    double total() const { return total_; }
    std::size_t size() const { return cumulative_.size(); }

private:
    std::vector<double> cumulative_;  // normalised, last entry 1
    double total_ = 0.0;
};

}  // namespace lucerna
