// What follows from the points of a sensor together: their mean, their extremes, and ratios.
#pragma once

#include <vector>

#include "optics/transport/calibration.h"

namespace lucerna::optics {

/// Figures of the points of one sensor. Points share photons and wavelengths, so that the noise of
/// a figure does not follow from theirs; it comes from the figures of batches of phases. What is
/// left of the biases of points is not correlated: on the dark side of a step it is light too many,
/// on the bright one too few.
class GridFigures {
public:
    /// @param first      bin of the first point; the others follow.
    /// @param bias_left  of each point, at least two: see Uncertain.
    GridFigures(const Calibration& calibration, std::size_t first, std::vector<double> bias_left);

    Uncertain mean() const;
    Uncertain minimum() const { return at(least_); }
    Uncertain maximum() const { return at(greatest_); }
    Uncertain minimum_to_mean() const;
    Uncertain minimum_to_maximum() const;

private:
    // A point that was chosen as the least or the greatest.
    struct Chosen {
        std::size_t point;
        double candidates;  // see Uncertain
    };
    double value(std::size_t point) const { return calibration_.value(first_ + point, 1); }
    // value(bin, part) as of Calibration::of().
    template <typename Value>
    double mean_of(const Value& value) const;
    double bias_of_mean() const;
    double candidates_for(std::size_t chosen) const;
    Uncertain at(const Chosen& chosen) const;
    // Of the least value to a denominator, a functional of value(bin, part).
    template <typename Denominator>
    Uncertain minimum_to(const Denominator& denominator, double candidates, double bias) const;

    const Calibration& calibration_;
    std::size_t first_;
    std::vector<double> bias_left_;
    Chosen least_, greatest_;
};

}  // namespace lucerna::optics
