#include "core/statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace lucerna {
namespace {

// Variance of the mean of `count` values; 0 is exact, not rounded below 0.
double variance_of_mean(double sum, double sum_of_squares, std::uint64_t count) {
    if (count < 2) return std::numeric_limits<double>::infinity();
    const auto n = static_cast<double>(count);
    const double spread = sum_of_squares - sum * sum / n;
    return std::max(0.0, spread) / (n * (n - 1.0));
}

// Regularised incomplete beta function I_x(a, b) by its continued fraction
// (Lentz's method; DLMF 8.17.22). Used for Student's t below.
double incomplete_beta(double a, double b, double x) {
    if (x <= 0.0) return 0.0;
    if (x >= 1.0) return 1.0;
    if (x > (a + 1.0) / (a + b + 2.0)) return 1.0 - incomplete_beta(b, a, 1.0 - x);
    const double front = std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) +
                                  a * std::log(x) + b * std::log1p(-x)) /
                         a;
    constexpr double tiny = 1e-300;
    double f = 1.0;
    double c = 1.0;
    double d = 0.0;
    for (int i = 0; i < 400; ++i) {
        const int m = i / 2;
        double numerator = 1.0;
        if (i > 0 && i % 2 == 0) {
            numerator = m * (b - m) * x / ((a + 2.0 * m - 1.0) * (a + 2.0 * m));
        } else if (i > 0) {
            numerator = -(a + m) * (a + b + m) * x / ((a + 2.0 * m) * (a + 2.0 * m + 1.0));
        }
        d = 1.0 + numerator * d;
        if (std::abs(d) < tiny) d = tiny;
        d = 1.0 / d;
        c = 1.0 + numerator / c;
        if (std::abs(c) < tiny) c = tiny;
        f *= c * d;
        if (std::abs(1.0 - c * d) < 1e-15) break;
    }
    return front * (f - 1.0);
}

}  // namespace

double student_t(double coverage, double degrees) {
    // P(|T| > t) = I_x(degrees/2, 1/2) with x = degrees / (degrees + t^2)   (DLMF 8.17, A&S 26.7.1)
    const auto outside = [&](double t) {
        return incomplete_beta(degrees / 2.0, 0.5, degrees / (degrees + t * t));
    };
    double low = 0.0;
    double high = 1.0;
    while (outside(high) > 1.0 - coverage && high < 1e12) high *= 2.0;
    for (int i = 0; i < 200 && high - low > 1e-12 * high; ++i) {
        const double middle = 0.5 * (low + high);
        (outside(middle) > 1.0 - coverage ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

double Uncertain::expanded_uncertainty(double coverage) const {
    if (!(degrees_of_freedom >= 1.0)) return std::numeric_limits<double>::infinity();
    const double probability = 1.0 - (1.0 - coverage) / candidates;
    const double of_noise =
        standard_error == 0.0 ? 0.0 : student_t(probability, degrees_of_freedom) * standard_error;
    return std::hypot(of_noise, probability * bias_left);
}

void Estimate::add(double value, double bias) {
    ++count_;
    sum_ += value;
    sum_of_squares_ += value * value;
    bias_sum_ += bias;
    bias_sum_of_squares_ += bias * bias;
    product_sum_ += value * bias;
}

void Estimate::merge(const Estimate& other) {
    count_ += other.count_;
    sum_ += other.sum_;
    sum_of_squares_ += other.sum_of_squares_;
    bias_sum_ += other.bias_sum_;
    bias_sum_of_squares_ += other.bias_sum_of_squares_;
    product_sum_ += other.product_sum_;
}

double Estimate::degrees_of_freedom() const {
    return count_ == 0 ? 0.0 : static_cast<double>(count_ - 1);
}

double Estimate::mean() const {
    return count_ == 0 ? 0.0 : sum_ / static_cast<double>(count_);
}

double Estimate::mean_standard_error() const {
    return std::sqrt(variance_of_mean(sum_, sum_of_squares_, count_));
}

double Estimate::bias() const {
    return count_ == 0 ? 0.0 : bias_sum_ / static_cast<double>(count_);
}

double Estimate::bias_standard_error() const {
    return std::sqrt(variance_of_mean(bias_sum_, bias_sum_of_squares_, count_));
}

double Estimate::bias_left() const {
    return 0.5 * std::sqrt(std::max(0.0, bias_square()));
}

double Estimate::standard_error(double share) const {
    // Of v - c b: the sum of its squares follows from those of v and b and of their product.
    const double squares =
        sum_of_squares_ - 2.0 * share * product_sum_ + share * share * bias_sum_of_squares_;
    return std::sqrt(variance_of_mean(sum_ - share * bias_sum_, squares, count_));
}

double Estimate::bias_square() const {
    return bias() * bias() - variance_of_mean(bias_sum_, bias_sum_of_squares_, count_);
}

double Estimate::corrected_share(double expected_bias) const {
    if (count_ < 2) return 1.0;
    const double measured = bias() * bias();
    const double noise = variance_of_mean(bias_sum_, bias_sum_of_squares_, count_);
    // As far from 0 as 4 standard deviations of a normal distribution (Wallace, Annals of
    // Mathematical Statistics 30 (1959), 1121: t^2 = v (exp(u^2 / v) - 1), which is above u^2).
    const double degrees = degrees_of_freedom();
    const bool is_clear =
        measured > 16.0 * noise && measured > degrees * std::expm1(16.0 / degrees) * noise;
    const double square = is_clear ? measured - noise : expected_bias * expected_bias;
    if (!(square + noise > 0.0)) return 1.0;
    // Var(v - b) = Var v - 2 Cov(v, b) + Var b. The error of v - c b is
    // Var v - 2 c Cov(v, b) + c^2 Var b + (1 - c)^2 square.
    const double covariance =
        0.5 *
        (variance_of_mean(sum_, sum_of_squares_, count_) + noise -
         variance_of_mean(sum_ - bias_sum_,
                          sum_of_squares_ - 2.0 * product_sum_ + bias_sum_of_squares_, count_));
    return std::clamp((square + covariance) / (square + noise), 0.0, 1.0);
}

double Estimate::expanded_uncertainty(double coverage) const {
    return corrected().expanded_uncertainty(coverage);
}

void StepBias::add(const Vec3& slope, const Vec3& step) {
    ++count_;
    slope_sum_ += slope;
    sum_ += step;
    sum_of_squares_ += step.cwiseAbs2();
}

void StepBias::merge(const StepBias& other) {
    count_ += other.count_;
    slope_sum_ += other.slope_sum_;
    sum_ += other.sum_;
    sum_of_squares_ += other.sum_of_squares_;
}

double StepBias::beyond_noise() const {
    if (count_ < 2) return 0.0;
    constexpr double variances_of_noise = 2.0;
    constexpr double left_if_it_points_away = 0.25;
    double noise = 0.0;
    for (int i = 0; i < 3; ++i) noise += variance_of_mean(sum_[i], sum_of_squares_[i], count_);
    const double mean_square = (sum_ / static_cast<double>(count_)).squaredNorm();
    const double bias = std::sqrt(std::max(0.0, mean_square - variances_of_noise * noise));
    return sum_.dot(slope_sum_) > 0.0 ? bias : left_if_it_points_away * bias;
}

}  // namespace lucerna
