// Means over wavelength for light of an equal-energy spectrum.
#pragma once

#include "spectral/observer.h"

namespace lucerna::truth {

/// Mean of f(wavelength in nm), weighted by a colour-matching function; a sum over the nodes of the
/// CIE's table at 1 nm.
template <typename Function>
double weighted_mean(const spectral::Spectrum& weight, const Function& f) {
    double sum = 0.0;
    double total = 0.0;
    for (int nm = 360; nm <= 830; ++nm) {
        sum += weight.at(nm) * f(static_cast<double>(nm));
        total += weight.at(nm);
    }
    return sum / total;
}

template <typename Function>
double luminous_mean(const Function& f) {
    return weighted_mean(spectral::v_lambda(), f);
}

}  // namespace lucerna::truth
