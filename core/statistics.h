// Values estimated from independent phases, with their standard error.
#pragma once

#include <cstdint>

namespace lucerna {

/// Running mean and spread of a functional that is computed once per phase (METHOD eq. 5, with N -
/// 1).
///
/// The phase is the statistical unit: photons and wavelengths are shared within it, so an error bar
/// taken inside a phase would be too small. `bias` runs beside the value: the kernel bias of the
/// same phase as measured from two radii.
class Estimate {
public:
    void add(double value, double bias = 0.0);
    /// Joins the phases of an independent run; exact up to rounding of sums.
    void merge(const Estimate& other);

    std::uint64_t count() const { return count_; }
    double mean() const;
    /// Standard deviation of the mean over phases; infinite for fewer than two phases.
    double standard_error() const;
    double bias() const;
    double bias_standard_error() const;
    /// Half width U of the interval mean +/- U: Student's t times the standard error, plus the
    /// measured kernel bias as a bound that adds to the noise linearly.
    double expanded_uncertainty(double coverage = 0.95) const;

private:
    std::uint64_t count_ = 0;
    double sum_ = 0.0;
    double sum_of_squares_ = 0.0;
    double bias_sum_ = 0.0;
    double bias_sum_of_squares_ = 0.0;
};

/// Two-sided quantile of Student's t: P(|T| <= t) = coverage with `degrees` >= 1 degrees of
/// freedom.
double student_t(double coverage, double degrees);

}  // namespace lucerna
