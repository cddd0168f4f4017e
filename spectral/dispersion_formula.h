// Dispersion formulas of refractive indices, numbered as in the refractiveindex.info database.
#pragma once

#include <string>
#include <vector>

#include "spectral/spectrum.h"

namespace lucerna::spectral {

/// One of the nine formulas of the refractiveindex.info database ("Dispersion formulas.pdf" there).
/// With lambda in micrometres and C1, C2 ... the coefficients in the order of the file:
///
///   1 Sellmeier     n^2 - 1 = C1 + sum of C2 lambda^2 / (lambda^2 - C3^2)
///   2 Sellmeier-2   n^2 - 1 = C1 + sum of C2 lambda^2 / (lambda^2 - C3)
///   3 polynomial    n^2 = C1 + sum of C2 lambda^C3
///   4 mixed         n^2 = C1 + two of C2 lambda^C3 / (lambda^2 - C4^C5) + sum of C10 lambda^C11
///   5 Cauchy        n = C1 + sum of C2 lambda^C3
///   6 gases         n - 1 = C1 + sum of C2 / (C3 - lambda^-2)
///   7 Herzberger    n = C1 + C2 h + C3 h^2 + C4 lambda^2 + C5 lambda^4 + C6 lambda^6,
///                   h = 1 / (lambda^2 - 0.028)
///   8 retro         (n^2 - 1) / (n^2 + 2) = C1 + C2 lambda^2 / (lambda^2 - C3) + C4 lambda^2
///   9 exotic        n^2 = C1 + C2 / (lambda^2 - C3) + C4 (lambda - C5) / ((lambda - C5)^2 + C6)
struct DispersionFormula {
    int number = 1;
    std::vector<double> coefficients;

    /// What is wrong with the number of the formula or of its coefficients; empty if nothing is.
    std::string problem() const;
    /// Index of refraction; NaN where the formula gives none. Needs problem() to be empty.
    double index_at(double wavelength_nm) const;
    /// The index as a table, held outside of the range, which linear interpolation follows to
    /// 3e-7. Throws std::domain_error if the formula has a pole or no positive index in the range.
    Spectrum tabulated(double from_nm, double to_nm) const;
};

}  // namespace lucerna::spectral
