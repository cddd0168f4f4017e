// Functionals of many values that share their phases: uniformities, ratios, chromaticities.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "core/statistics.h"

namespace lucerna {

/// Sums of many values over batches of consecutive phases. At most 64 batches are kept: when they
/// are full, neighbours are joined, so that memory does not grow with the number of phases.
///
/// A functional f(means) is taken of the means over all phases. Its standard error comes from the
/// jackknife: f of the means without one batch, for each batch in turn, which sees all correlations
/// of the values (Efron and Tibshirani, An Introduction to the Bootstrap, 1993, eq. 11.5). It is
/// consistent for smooth f.
class BatchMeans {
public:
    static constexpr std::size_t most_batches = 64;

    explicit BatchMeans(std::size_t value_count = 0)
        : value_count_(value_count),
          complete_(value_count),
          open_(value_count),
          outside_(value_count) {}

    /// Adds the values of one phase, as many as there are.
    void add(std::span<const double> values);
    /// Joins the phases of an independent run, of as many values. Its last batch, if incomplete,
    /// counts in the means alone.
    void merge(const BatchMeans& other);

    std::size_t value_count() const { return value_count_; }
    std::uint64_t phases() const { return phases_; }
    /// Complete ones.
    std::size_t batches() const { return complete_batches_; }
    double mean(std::size_t value) const;

    /// How two values vary together: sums over the complete batches of the products of their
    /// deviations, and of the squares of those of the other one.
    struct Covariation {
        double product, square;
    };
    Covariation covariation(std::size_t value, std::size_t other) const;

    /// The means over all phases, or over all complete batches but one.
    class Means {
    public:
        double operator()(std::size_t value) const {
            if (left_out_ == none) return all_.mean(value);
            return (all_.complete_[value] - all_.batch(left_out_)[value]) /
                   ((static_cast<double>(all_.complete_batches_) - 1.0) *
                    static_cast<double>(all_.batch_size_));
        }
        /// How a value follows another from batch to batch: the coefficient of the regression of
        /// its relative deviations on those of the other; 0 if that one is always the same, or the
        /// value 0.
        /// @param together  their covariation over all batches.
        double relative_slope(std::size_t value, std::size_t other,
                              const Covariation& together) const;

    private:
        friend class BatchMeans;
        static constexpr std::size_t none = most_batches;
        explicit Means(const BatchMeans& all, std::size_t left_out = none)
            : all_(all), left_out_(left_out) {}

        const BatchMeans& all_;
        std::size_t left_out_;
    };
    Means means() const { return Means(*this); }

    /// @param functional  double(const Means&).
    /// Of fewer than two phases the error is infinite, and without degrees of freedom.
    template <typename Functional>
    Uncertain of(const Functional& functional) const {
        Uncertain result{functional(means()), std::numeric_limits<double>::infinity(), 0.0};
        const std::size_t count = complete_batches_;
        if (count < 2) return result;
        const auto batches = static_cast<double>(count);
        double sum = 0.0;
        double squares = 0.0;
        for (std::size_t left_out = 0; left_out < count; ++left_out) {
            // Differences from the value itself keep the digits of the small spread.
            const double without = functional(Means(*this, left_out)) - result.value;
            sum += without;
            squares += without * without;
        }
        const double variance = (batches - 1.0) / batches * (squares - sum * sum / batches);
        // Phases beyond the last complete batch lower the error of the means as all others do.
        const double share =
            batches * static_cast<double>(batch_size_) / static_cast<double>(phases_);
        result.standard_error = std::sqrt(std::max(0.0, variance) * share);
        result.degrees_of_freedom = batches - 1.0;
        return result;
    }

    std::size_t bytes() const { return (batches_.size() + 3 * value_count_) * sizeof(double); }

    /// Saves to an archive or loads from one.
    template <typename Archive>
    void serialize(Archive& archive) {
        archive(phases_, batch_size_, complete_batches_, open_phases_, batches_, complete_, open_,
                outside_);
    }

private:
    std::span<const double> batch(std::size_t number) const {
        return std::span(batches_).subspan(number * value_count_, value_count_);
    }
    void join_pairs();

    std::size_t value_count_;
    std::uint64_t phases_ = 0;
    std::uint64_t batch_size_ = 1;  // phases of a complete batch
    std::uint64_t complete_batches_ = 0, open_phases_ = 0;
    std::vector<double> batches_;   // sums [batch][value], of the complete ones
    std::vector<double> complete_;  // per value, sum of the complete batches
    std::vector<double> open_;      // of the batch that is not complete yet
    std::vector<double> outside_;   // of phases that belong to no batch
};

}  // namespace lucerna
