// Measured luminous intensity distributions in the C-gamma system (CIE 121, EN 13032-1).
#pragma once

#include <vector>

#include "core/vector.h"

namespace lucerna::optics {

/// Luminous intensity over the sphere in the C-gamma system, on a full grid of C planes and gamma
/// angles (symmetries already unfolded), interpolated bilinearly.
///
/// Frame: gamma is measured from -z (nadir, gamma = 0 points down), C from +x toward +y (C = 0 is +x,
/// C = 90 is +y), seen from above counter-clockwise.
class IntensityDistribution {
public:
    /// @param c_deg       strictly increasing, from 0 to 360 inclusive (both planes given), or the
    ///                    single plane {0} for rotational symmetry.
    /// @param gamma_deg   strictly increasing within [0, 180]; zero intensity outside the range.
    /// @param intensity_cd  values [c][gamma], all >= 0 and finite, not all zero.
    IntensityDistribution(std::vector<double> c_deg, std::vector<double> gamma_deg,
                          std::vector<std::vector<double>> intensity_cd);

    /// Luminous intensity toward a unit direction in the photometric frame [cd].
    double intensity_cd(const Vec3& direction) const;
    /// Integral of the interpolant over the sphere [lm].
    double luminous_flux_lm() const { return flux_lm_; }
    double max_intensity_cd() const { return max_cd_; }

    /// Direction with density pdf_solid_angle(); exactly in proportion to the interpolated intensity
    /// or to a close bound of it (the caller weighs by intensity / pdf).
    Vec3 sample(double u1, double u2) const;
    double pdf_solid_angle(const Vec3& direction) const;

    const std::vector<double>& c_deg() const { return c_deg_; }
    const std::vector<double>& gamma_deg() const { return gamma_deg_; }

private:
    std::vector<double> c_deg_, gamma_deg_;
    std::vector<double> table_cd_;  // [c * gamma_count + gamma]
    double flux_lm_ = 0.0;
    double max_cd_ = 0.0;
};

}  // namespace lucerna::optics
