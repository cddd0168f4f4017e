// How often the stated intervals contain the truth.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "validation/outcome.h"

namespace lucerna::validation {

/// Part of a count, with the exact 95 % interval of the probability behind it (Clopper and Pearson,
/// Biometrika 26, 1934, 404). It takes the trials as independent; checks of one run share photons,
/// so that the true interval is somewhat wider.
struct Share {
    std::size_t hits = 0, trials = 0;
    double fraction() const;
    double lower() const;
    double upper() const;
};

/// Smallest and largest number of hits of 95 % of all sets of `trials` if each hits with the
/// probability `p`.
std::array<std::size_t, 2> binomial_bounds(std::size_t trials, double p);

/// Coverage of all checks of one quantity, or of all. Readings whose truth is not known to a
/// quarter of their U are left out.
struct Coverage {
    std::string quantity;
    Share stated;  ///< truth within value +/- U
    /// Truth within 1.96 standard errors of the uncorrected mean: docs/method.md eq. 5 alone,
    /// without bias.
    Share noise_only;
    double mean_z = 0.0;
    /// Median over checks of the median U over seeds, divided by 1.96 times the standard deviation
    /// of the value over seeds; only where there are at least ten seeds.
    std::optional<double> relative_width;
};

/// One row per quantity, in the order of appearance, and a last one over all.
std::vector<Coverage> coverage(const std::vector<CaseOutcome>& outcomes);

}  // namespace lucerna::validation
