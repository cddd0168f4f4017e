// Fresnel's equations for a boundary of two lossless media, total reflection with its phases.
#pragma once

#include <algorithm>
#include <cmath>
#include <complex>

namespace lucerna::truth {

/// Amplitudes of the reflected field and reflectances, for light polarised across (s) and in (p)
/// the plane of incidence. The p vectors are k x s for the incident and the reflected direction k
/// alike, so that at normal incidence p = -s (Born and Wolf, Principles of Optics, 7th ed., 1.5.2,
/// eq. 21a).
struct Reflection {
    std::complex<double> amplitude_s, amplitude_p;
    double cosine_refracted = 0.0;  ///< 0 at total reflection

    double reflectance_s() const { return std::norm(amplitude_s); }
    double reflectance_p() const { return std::norm(amplitude_p); }
    /// Of unpolarised light.
    double reflectance() const { return 0.5 * (reflectance_s() + reflectance_p()); }
};

/// @param cosine  of the angle of incidence, 0 to 1.
inline Reflection reflection(double index_from, double index_to, double cosine) {
    const double relative = index_from / index_to;
    const double squared = 1.0 - relative * relative * (1.0 - cosine * cosine);
    // Beyond the critical angle the cosine is imaginary (Born and Wolf, 1.5.4, eq. 54).
    const std::complex<double> refracted = squared >= 0.0
                                               ? std::complex<double>(std::sqrt(squared), 0.0)
                                               : std::complex<double>(0.0, std::sqrt(-squared));
    return {
        (index_from * cosine - index_to * refracted) / (index_from * cosine + index_to * refracted),
        (index_to * cosine - index_from * refracted) / (index_to * cosine + index_from * refracted),
        refracted.real()};
}

}  // namespace lucerna::truth
