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
    /// The phase's common lanes are this one, 0 or 1 and as likely, and every second one after it.
    int first_common = 0;

    /// Values of a spectrum at these wavelengths.
    Lanes at(const Spectrum& spectrum) const;
};

/// Whether paths of the scene are split by wavelength, so that a single lane carries each of them.
enum class Dispersion { none, present };

/// Draws the wavelength set of each phase from a density that follows the scene's emission, seen by
/// the eye:
///
///   p = a [emission V] + b [emission (x-bar + y-bar + z-bar)] + c [emission] + d [uniform],
///
/// where [ ] is a function scaled to area 1. V serves luminance, the colour-matching functions keep
/// colour from being noisier than luminance, the emission itself serves spectral results, and the
/// uniform part makes sure that no wavelength is missed.
///
/// Without dispersion (a b c d) = (0.40 0.40 0.18 0.02): the sum over the strata is smooth in their
/// shift, so that the luminance of a grey scene varies from phase to phase by 0.3 to 1.4 % for
/// CIE E, A, LED-B3, LED-RGB1 and FL11, X by 1.4 to 3.3 % and Z by 4 to 18 %. More weight on V
/// would not steady luminance (0.8 0.15 0 0.05: 1.0 to 1.8 %) but makes Z three to five times as
/// noisy. With dispersion each path has one wavelength for all, and what counts is how much
/// emission V / p varies over the spectrum: (0.80 0.10 0.08 0.02) halves that, from about 47 % to
/// 25 %.
class WavelengthSampler {
public:
    /// @param emission  spectral radiant flux of all lights together [any scale].
    /// Throws std::invalid_argument if it is negative anywhere in 360-830 nm or zero everywhere.
    explicit WavelengthSampler(const Spectrum& emission, Dispersion dispersion = Dispersion::none);

    /// Wavelengths of a phase, in increasing order; depends on (seed, phase, part) only.
    ///
    /// Part 0 is the phase's common set. Any range of further parts, for rays that meet none of the
    /// other direction, covers the spectrum evenly: their shifts are a Kronecker sequence.
    ///
    /// The shift of all strata and the common lanes are drawn anew for each phase: then phases are
    /// independent, and their spread states the error of their mean. (A sequence that fills the
    /// interval evenly over the phases would err less, but nothing in the run could tell by how
    /// much: stated errors of quiet readings would be several times too large.)
    WavelengthSet sample(std::uint64_t seed, std::uint32_t phase, std::uint32_t part = 0) const;

    /// Density per nm at a wavelength; integrates to 1 over [360, 830] nm, zero outside.
    double pdf_per_nm(double wavelength_nm) const;

private:
    double quantile_nm(double probability) const;

    std::vector<double> density_;     // per nm at 1 nm nodes, piecewise linear
    std::vector<double> cumulative_;  // at the nodes
};

}  // namespace lucerna::spectral
