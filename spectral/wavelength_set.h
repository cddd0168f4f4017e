// The wavelengths that all rays of a phase share (DESIGN decision 2).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "spectral/lanes.h"
#include "spectral/spectrum.h"

namespace lucerna::spectral {

/// The wavelengths of one phase and the weights that turn lanes into integrals over wavelength:
///
///   integral of g(lambda) d lambda  ~  sum_k g(lambda_k) * interval_nm[k],   interval = 1 / (N p)
///
/// unbiased, because the set is one shift of a stratification of the density p.
struct WavelengthSet {
    std::array<double, lane_count> wavelength_nm;
    Lanes interval_nm;  ///< quadrature weight of each lane [nm]
    Lanes luminance;    ///< K_m V(lambda) interval: spectral radiance [W/(m2 sr nm)] -> cd/m2
    Lanes x;            ///< the same with x-bar: -> X on the scale where Y is cd/m2
    Lanes z;            ///< the same with z-bar
    int hero = 0;       ///< the lane that goes on alone behind a dispersive refraction, uniform

    /// Values of a spectrum at these wavelengths.
    Lanes at(const Spectrum& spectrum) const;
};

/// Draws the wavelength set of each phase from a density that follows the photometric weight of the
/// scene's emission, with a defensive uniform part so that no wavelength is missed.
class WavelengthSampler {
public:
    /// @param emission  spectral radiant flux of all lights together [any scale], not all zero.
    explicit WavelengthSampler(const Spectrum& emission);

    /// Wavelengths of a phase: sorted strata of equal probability, shifted by one number per phase
    /// that follows a randomised low-discrepancy sequence over the phases; hero lane uniform,
    /// likewise equidistributed over phases. Depends on (seed, phase) only.
    WavelengthSet sample(std::uint64_t seed, std::uint32_t phase) const;

    /// Density per nm at a wavelength; integrates to 1 over [360, 830] nm.
    double pdf_per_nm(double wavelength_nm) const;

private:
    std::vector<double> density_;     // per nm at 1 nm nodes, piecewise linear
    std::vector<double> cumulative_;  // at the nodes
};

}  // namespace lucerna::spectral
