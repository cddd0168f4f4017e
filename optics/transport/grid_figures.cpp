#include "optics/transport/grid_figures.h"

#include <algorithm>

namespace lucerna::optics {
namespace {

// Points whose value is as near to the least one as this many standard errors of the difference
// might be the least in truth.
constexpr double rival_errors = 2.0;

Uncertain with(Uncertain result, double candidates, double bias_left) {
    result.candidates = candidates;
    result.bias_left = std::max(bias_left, relative_rounding * std::abs(result.value));
    return result;
}

double relative(double bias, double value) {
    return value > 0.0 ? bias / value : 0.0;
}

}  // namespace

GridFigures::GridFigures(const Calibration& calibration, std::size_t first,
                         std::vector<double> bias_left)
    : calibration_(calibration), first_(first), bias_left_(std::move(bias_left)) {
    std::size_t least = 0, greatest = 0;
    for (std::size_t k = 1; k < bias_left_.size(); ++k) {
        if (value(k) < value(least)) least = k;
        if (value(k) > value(greatest)) greatest = k;
    }
    least_ = {least, candidates_for(least)};
    greatest_ = {greatest, candidates_for(greatest)};
}

template <typename Value>
double GridFigures::mean_of(const Value& value) const {
    double sum = 0.0;
    for (std::size_t k = 0; k < bias_left_.size(); ++k) sum += value(first_ + k, 1);
    return sum / static_cast<double>(bias_left_.size());
}

double GridFigures::bias_of_mean() const {
    double squares = 0.0;
    for (const double bias : bias_left_) squares += square(bias);
    return std::sqrt(squares) / static_cast<double>(bias_left_.size());
}

double GridFigures::candidates_for(std::size_t chosen) const {
    double candidates = 1.0;
    for (std::size_t k = 0; k < bias_left_.size(); ++k) {
        if (k == chosen) continue;
        // The difference is often known far better than either.
        const Uncertain apart = calibration_.of(
            [&](auto&& value) { return value(first_ + k, 1) - value(first_ + chosen, 1); });
        if (std::abs(apart.value) <= rival_errors * apart.standard_error) ++candidates;
    }
    return candidates;
}

Uncertain GridFigures::mean() const {
    return with(calibration_.of([&](auto&& value) { return mean_of(value); }), 1.0, bias_of_mean());
}

Uncertain GridFigures::at(const Chosen& chosen) const {
    return with(calibration_.of([&](auto&& value) { return value(first_ + chosen.point, 1); }),
                chosen.candidates, bias_left_[chosen.point]);
}

template <typename Denominator>
Uncertain GridFigures::minimum_to(const Denominator& denominator, double candidates,
                                  double bias) const {
    const std::size_t least = least_.point;
    const Uncertain ratio = calibration_.of(
        [&](auto&& value) { return value(first_ + least, 1) / denominator(value); });
    const double whole = denominator(
        [&](std::size_t bin, std::size_t part) { return calibration_.value(bin, part); });
    const double bias_of_ratio =
        ratio.value * std::hypot(relative(bias_left_[least], value(least)), relative(bias, whole));
    return with(ratio, candidates, bias_of_ratio);
}

Uncertain GridFigures::minimum_to_mean() const {
    return minimum_to([&](auto&& value) { return mean_of(value); }, least_.candidates,
                      bias_of_mean());
}

Uncertain GridFigures::minimum_to_maximum() const {
    return minimum_to([&](auto&& value) { return value(first_ + greatest_.point, 1); },
                      least_.candidates * greatest_.candidates, bias_left_[greatest_.point]);
}

}  // namespace lucerna::optics
