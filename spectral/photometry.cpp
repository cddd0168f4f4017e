#include "spectral/photometry.h"

#include <cmath>
#include <stdexcept>

#include "spectral/integral.h"
#include "spectral/observer.h"

namespace lucerna::spectral {

double luminous(const Spectrum& spectral) {
    return max_luminous_efficacy_lm_per_w * integral_of_product(spectral, v_lambda());
}

double luminous_efficacy_of_radiation(const Spectrum& spectral) {
    const double radiant = integral_of_product(spectral, 1.0);
    if (!(radiant > 0.0)) throw std::invalid_argument("spectrum has no radiant flux in 360-830 nm");
    return luminous(spectral) / radiant;
}

Spectrum scaled_to_luminous(const Spectrum& relative, double luminous_flux_lm) {
    if (!(luminous_flux_lm >= 0.0) || std::isinf(luminous_flux_lm)) {
        throw std::invalid_argument("luminous flux must be finite and not negative");
    }
    const double content = luminous(relative);
    if (!(content > 0.0)) {
        throw std::invalid_argument("spectrum has no luminous content: it is zero in 360-830 nm");
    }
    return relative.scaled(luminous_flux_lm / content);
}

}  // namespace lucerna::spectral
