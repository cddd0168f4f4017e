// Measured luminous intensity distributions in the C-gamma system (CIE 121, EN 13032-1).
#pragma once

#include <vector>

#include "core/sampling.h"
#include "core/vector.h"

namespace lucerna::optics {

/// Luminous intensity over the sphere in the C-gamma system, on a full grid of C planes and gamma
/// angles (symmetries already unfolded), interpolated bilinearly in the angles.
///
/// Frame: gamma is measured from -z (nadir, gamma = 0 points down), C from +x toward +y (C = 0 is
/// +x, C = 90 is +y), seen from above counter-clockwise.
class IntensityDistribution {
public:
    /// @param c_deg       strictly increasing, from 0 to 360 inclusive (both planes given), or the
    ///                    single plane {0} for rotational symmetry.
    /// @param gamma_deg   strictly increasing within [0, 180], at least two; zero intensity
    /// outside.
    /// @param intensity_cd  values [c][gamma], all >= 0 and finite, not all zero.
    /// Throws std::invalid_argument if any of this does not hold.
    IntensityDistribution(std::vector<double> c_deg, std::vector<double> gamma_deg,
                          std::vector<std::vector<double>> intensity_cd);

    /// Luminous intensity toward a unit direction in the photometric frame [cd].
    double intensity_cd(const Vec3& direction) const;
    /// Integral of the interpolant over the sphere [lm], in closed form.
    double luminous_flux_lm() const { return cells_.total(); }
    /// Integral of the interpolant over a zone of gamma [lm], in closed form.
    double zonal_flux_lm(double gamma_from_deg, double gamma_to_deg) const;
    double max_intensity_cd() const { return max_cd_; }
    /// Direction of the largest tabulated intensity.
    Vec3 max_direction() const { return direction(max_c_deg_, max_gamma_deg_); }
    double max_c_deg() const { return max_c_deg_; }
    double max_gamma_deg() const { return max_gamma_deg_; }

    /// Direction with density pdf_solid_angle(), exactly in proportion to the interpolated
    /// intensity.
    Vec3 sample(double u1, double u2) const;
    /// intensity_cd(direction) / luminous_flux_lm() [1/sr].
    double pdf_solid_angle(const Vec3& direction) const;

    const std::vector<double>& c_deg() const { return c_deg_; }
    const std::vector<double>& gamma_deg() const { return gamma_deg_; }

    /// Unit vector of a direction given by its angles.
    static Vec3 direction(double c_deg, double gamma_deg);

private:
    double at(std::size_t c, std::size_t gamma) const {
        return table_cd_[c * gamma_rad_.size() + gamma];
    }

    std::vector<double> c_deg_, gamma_deg_;
    std::vector<double> c_rad_, gamma_rad_;
    std::vector<double> table_cd_;  // [c * gamma_count + gamma]
    DiscreteDistribution cells_;    // flux of each cell, [c * (gamma_count - 1) + gamma]
    double max_cd_ = 0.0;
    double max_c_deg_ = 0.0, max_gamma_deg_ = 0.0;
};

}  // namespace lucerna::optics
