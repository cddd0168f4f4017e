// A function of wavelength.
#pragma once

#include <vector>

#include "spectral/lanes.h"

namespace lucerna::spectral {

/// The range in which Lucerna simulates; the CIE observers are tabulated on it.
inline constexpr double min_wavelength_nm = 360.0;
inline constexpr double max_wavelength_nm = 830.0;

/// What a tabulated spectrum is outside its table.
enum class Outside {
    zero,  ///< emission: nothing was measured there, and nothing is emitted
    hold   ///< reflectance, index, absorption: the value at the end of the table
};

/// A constant, or a table that is interpolated linearly. Its unit is said where it is used.
class Spectrum {
public:
    /// The same value at every wavelength.
    Spectrum(double constant = 0.0);  // NOLINT: a number is a spectrum
    /// Strictly increasing wavelengths [nm] and as many values, all finite; two at least if it is
    /// zero outside. Throws std::invalid_argument else.
    Spectrum(std::vector<double> wavelengths_nm, std::vector<double> values, Outside outside);

    double at(double wavelength_nm) const;
    bool is_constant() const { return wavelengths_nm_.empty(); }
    /// Largest and smallest value on [min_wavelength_nm, max_wavelength_nm].
    double max() const;
    double min() const;
    Spectrum scaled(double factor) const;

    const std::vector<double>& wavelengths_nm() const { return wavelengths_nm_; }
    const std::vector<double>& values() const { return values_; }
    Outside outside() const { return outside_; }

private:
    std::vector<double> wavelengths_nm_;  // empty: constant
    std::vector<double> values_;          // constant: one entry
    Outside outside_ = Outside::hold;
};

}  // namespace lucerna::spectral
