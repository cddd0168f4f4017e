// Readings of sensors without the luck of the wavelengths of their phases.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/batch_means.h"

namespace lucerna::optics {

/// Share of a value that single precision of spectra may round: of direct light, which is read with
/// hardly any noise once the luck of the wavelengths is taken off, up to 2e-7 is seen.
inline constexpr double relative_rounding = 1e-6;

/// The wavelengths of a phase bring more or less of the emission than there is, which is known: by
/// 0.5 % of its luminance, and much more of its colour. Readings follow that as far as their light
/// comes straight or is scattered, wholly in grey scenes; light behind dispersive glass has
/// wavelengths of its own. By how much is a regression over batches of phases, so that what is
/// reported is a ratio estimator where that is of use. It is biased by O(1 / phases) of the phases'
/// variance.
class Calibration {
public:
    /// @param sums      X, Y, Z of each bin, and last those of the emission of all lights on the
    ///     wavelengths of the phases.
    /// @param emission  X, Y, Z of all lights, exact.
    Calibration(const BatchMeans& sums, const Vec3& emission)
        : sums_(sums), emission_(emission), first_of_emission_(sums.value_count() - 3) {
        // Fewer tell no slope: all light is taken to follow the emission.
        constexpr std::size_t least_batches = 8;
        if (sums_.batches() < least_batches) return;
        for (std::size_t i = 0; i < first_of_emission_; ++i) {
            with_emission_.push_back(sums_.covariation(i, emission_of(i)));
        }
    }

    /// X, Y or Z (part 0, 1, 2) of a bin.
    double value(std::size_t bin, std::size_t part) const {
        return value(sums_.means(), bin, part);
    }

    /// functional(value), where value(bin, part) are those of the means; less one degree of freedom
    /// for the slope. The batches that the jackknife leaves tell the slope anew: its own error
    /// would else be missing, some 4 % of the standard error after 19 phases.
    template <typename Functional>
    Uncertain of(const Functional& functional) const {
        Uncertain result = sums_.of([&](const BatchMeans::Means& means) {
            return functional(
                [&](std::size_t bin, std::size_t part) { return value(means, bin, part); });
        });
        if (regressed()) result.degrees_of_freedom -= 1.0;
        return result;
    }

private:
    bool regressed() const { return !with_emission_.empty(); }
    // Number of the emission's value of the same part.
    std::size_t emission_of(std::size_t i) const { return first_of_emission_ + i % 3; }

    double value(const BatchMeans::Means& means, std::size_t bin, std::size_t part) const {
        const std::size_t i = 3 * bin + part;
        const double reading = means(i);
        const double follows =
            regressed()
                ? std::clamp(means.relative_slope(i, emission_of(i), with_emission_[i]), 0.0, 1.0)
                : 1.0;
        if (follows == 0.0) return reading;
        return reading *
               std::pow(emission_[static_cast<Eigen::Index>(part)] / means(emission_of(i)),
                        follows);
    }

    const BatchMeans& sums_;
    const Vec3& emission_;
    std::size_t first_of_emission_;
    std::vector<BatchMeans::Covariation> with_emission_;  // of all values, if they are regressed
};

}  // namespace lucerna::optics
