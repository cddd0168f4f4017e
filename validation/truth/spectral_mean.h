// Means over wavelength.
#pragma once

#include <functional>

#include "spectral/observer.h"
#include "validation/truth/quadrature.h"

namespace lucerna::truth {

/// Integral over 360 ... 830 nm of light(nm) * weight(nm) * f(nm), eight nodes of Gauss and
/// Legendre on each nanometre: the CIE's functions are linear there.
template <typename Light, typename Function>
double spectral_integral(const spectral::Spectrum& weight, const Light& light, const Function& f) {
    return integral([&](double nm) { return weight.at(nm) * light(nm) * f(nm); },
                    spectral::min_wavelength_nm, spectral::max_wavelength_nm, 470);
}

/// Mean of f(nm) over light of a relative spectral distribution, weighted by V(lambda).
template <typename Light, typename Function>
double luminous_mean(const Light& light, const Function& f) {
    return spectral_integral(spectral::v_lambda(), light, f) /
           spectral_integral(spectral::v_lambda(), light, [](double) { return 1.0; });
}

}  // namespace lucerna::truth
