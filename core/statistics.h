// Values estimated from independent phases, with their uncertainty.
#pragma once

#include <cstdint>

#include "core/vector.h"

namespace lucerna {

/// Two-sided quantile of Student's t: P(|T| <= t) = coverage with `degrees` >= 1 degrees of
/// freedom.
double student_t(double coverage, double degrees);

/// A number with the uncertainty that a finite number of phases leaves to it.
struct Uncertain {
    double value = 0.0;
    double standard_error = 0.0;      ///< infinite if nothing is known of it
    double degrees_of_freedom = 0.0;  ///< of the standard error
    /// Among how many candidates the value was chosen as the least or the greatest, so that its
    /// noise was chosen too; the uncertainty covers all of them (Bonferroni's inequality).
    double candidates = 1.0;
    /// Half width of the interval that what the correction of a bias leaves behind lies in, evenly
    /// (GUM, JCGM 100:2008, 4.3.7).
    double bias_left = 0.0;

    /// Half width U of the interval value +/- U that holds the truth with this probability: that of
    /// noise and that of bias, added as squares.
    double expanded_uncertainty(double coverage = 0.95) const;
};

/// Running mean and spread of a functional that is computed once per phase
/// (docs/method.md eq. 5).
///
/// The phase is the statistical unit: photons and wavelengths are shared within it, so an error bar
/// taken inside a phase would be too small. `bias` runs beside the value: the kernel bias of the
/// same phase as a wide and a narrow kernel tell it from the same photons. The value that is
/// reported has the measured bias taken off, and the noise of the correction is part of the spread
/// over phases. What is left is of fourth order in the radius where the light is smooth. Beside an
/// edge at 0.3 radii or further up to half of the measured bias is left, which is taken as its
/// bound.
class Estimate {
public:
    void add(double value, double bias = 0.0);
    /// Joins the phases of an independent run; exact up to rounding of sums.
    void merge(const Estimate& other);

    std::uint64_t count() const { return count_; }
    double degrees_of_freedom() const;

    /// Mean with this share of the bias taken off, 0 to 1, and the standard deviation of that
    /// over phases; infinite for fewer than two phases.
    double value(double share = 1.0) const { return mean() - share * bias(); }
    double standard_error(double share = 1.0) const;
    /// The share of the bias to take off for the least mean square error of value(), since the
    /// correction has noise of its own: by the measured bias where that is clear of its noise, else
    /// by `expected_bias`, the root mean square of biases such as this one. 1 for fewer than two
    /// phases.
    double corrected_share(double expected_bias) const;
    Uncertain corrected() const {
        return {value(), standard_error(), degrees_of_freedom(), 1.0, bias_left()};
    }
    /// What is left of the bias at most, by the measured bias less its noise.
    double bias_left() const;
    /// Half width U of the interval value() +/- U.
    double expanded_uncertainty(double coverage = 0.95) const;

    /// Mean as estimated, kernel bias included, and its standard deviation (docs/method.md eq. 5).
    double mean() const;
    double mean_standard_error() const;
    double bias() const;
    double bias_standard_error() const;
    /// Square of the bias without that of its noise, on average; below 0 by chance.
    double bias_square() const;

    /// Saves to an archive or loads from one.
    template <typename Archive>
    void serialize(Archive& archive) {
        archive(count_, sum_, sum_of_squares_, bias_sum_, bias_sum_of_squares_, product_sum_);
    }

private:
    std::uint64_t count_ = 0;
    double sum_ = 0.0;
    double sum_of_squares_ = 0.0;
    double bias_sum_ = 0.0;
    double bias_sum_of_squares_ = 0.0;
    double product_sum_ = 0.0;  // of value and bias
};

/// What a step of light within a kernel may leave of its bias. Two moments of the light are
/// computed once per phase: one points to where it is brighter; the other has the length of the
/// bias that a step through the middle leaves, and the same direction.
class StepBias {
public:
    void add(const Vec3& slope, const Vec3& step);
    /// Joins the phases of an independent run.
    void merge(const StepBias& other);

    /// The bias as far as noise does not explain it: of its square twice the variance of the mean
    /// is taken off, which noise alone exceeds in one of e^2 cases. 0 for fewer than two phases.
    /// Where the second moment points away from the first, the step is at more than 0.4 radii, and
    /// a quarter of its length bounds what is left.
    double beyond_noise() const;

    /// Saves to an archive or loads from one.
    template <typename Archive>
    void serialize(Archive& archive) {
        archive(count_);
        for (int i = 0; i < 3; ++i) archive(slope_sum_[i], sum_[i], sum_of_squares_[i]);
    }

private:
    std::uint64_t count_ = 0;
    Vec3 slope_sum_ = Vec3::Zero();
    Vec3 sum_ = Vec3::Zero();
    Vec3 sum_of_squares_ = Vec3::Zero();
};

}  // namespace lucerna
