#include "core/sampling.h"

#include <algorithm>
#include <stdexcept>

namespace lucerna {

Vec2 sample_disk(double u1, double u2) {
    const double x = 2.0 * u1 - 1.0;
    const double y = 2.0 * u2 - 1.0;
    if (x == 0.0 && y == 0.0) return Vec2::Zero();
    const bool wide = std::abs(x) > std::abs(y);
    const double radius = wide ? x : y;
    const double angle = wide ? pi / 4.0 * (y / x) : pi / 2.0 - pi / 4.0 * (x / y);
    return {radius * std::cos(angle), radius * std::sin(angle)};
}

Vec2 numbers_of_disk_sample(const Vec2& point) {
    const double radius = point.norm();
    double x = radius;
    double y = 0.0;
    // Sectors of a quarter turn around the four axes; within one the angle is in proportion.
    const double quarters = std::atan2(point.y(), point.x()) / (pi / 2.0);
    const double axis = std::round(quarters);
    const double across = 2.0 * radius * (quarters - axis);
    const int sector = (static_cast<int>(axis) + 4) % 4;
    if (sector == 0) {
        y = across;
    } else if (sector == 1) {
        x = -across;
        y = radius;
    } else if (sector == 2) {
        x = -radius;
        y = -across;
    } else {
        x = across;
        y = -radius;
    }
    const auto number = [](double coordinate) {
        return std::clamp(0.5 * (coordinate + 1.0), 0.0, std::nextafter(1.0, 0.0));
    };
    return {number(x), number(y)};
}

Vec3 sample_cosine_hemisphere(double u1, double u2) {
    const Vec2 d = sample_disk(u1, u2);
    return {d.x(), d.y(), std::sqrt(std::max(0.0, 1.0 - d.squaredNorm()))};
}

Vec3 sample_cone(double cos_half_angle, double u1, double u2) {
    // 1 - cos is sampled, so that narrow cones keep their digits.
    const double one_minus_cos = u1 * (1.0 - cos_half_angle);
    const double cos_theta = 1.0 - one_minus_cos;
    const double sin_theta = std::sqrt(std::max(0.0, one_minus_cos * (1.0 + cos_theta)));
    const double phi = 2.0 * pi * u2;
    return {sin_theta * std::cos(phi), sin_theta * std::sin(phi), cos_theta};
}

Vec3 sample_sphere(double u1, double u2) {
    return sample_cone(-1.0, u1, u2);
}

DiscreteDistribution::DiscreteDistribution(std::span<const double> weights) {
    cumulative_.reserve(weights.size());
    for (const double weight : weights) {
        if (!(weight >= 0.0)) throw std::invalid_argument("negative or undefined weight");
        cumulative_.push_back(total_ += weight);
    }
    if (!(total_ > 0.0)) throw std::invalid_argument("all weights are zero");
    for (double& value : cumulative_) value /= total_;
}

std::size_t DiscreteDistribution::sample(double u, double* rest) const {
    const auto it = std::upper_bound(cumulative_.begin(), cumulative_.end() - 1, u);
    const auto index = static_cast<std::size_t>(it - cumulative_.begin());
    if (rest) {
        const double below = index == 0 ? 0.0 : cumulative_[index - 1];
        *rest = std::clamp((u - below) / (*it - below), 0.0, std::nextafter(1.0, 0.0));
    }
    return index;
}

double DiscreteDistribution::probability(std::size_t index) const {
    return cumulative_[index] - (index == 0 ? 0.0 : cumulative_[index - 1]);
}

}  // namespace lucerna
