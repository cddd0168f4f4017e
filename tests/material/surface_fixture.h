// A surface between two media on the lanes of one phase, built by hand.
#pragma once

#include <vector>

#include "optics/material/bsdf.h"

namespace lucerna::test {

using optics::Bsdf;
using optics::BsdfId;
using optics::SpectrumId;
using spectral::Lanes;

inline Lanes lanes(double value) {
    return Lanes::Constant(static_cast<float>(value));
}
/// Values that fall or rise linearly over the lanes.
inline Lanes ramp(double first, double last) {
    return Lanes::LinSpaced(spectral::lane_count, static_cast<float>(first),
                            static_cast<float>(last));
}

struct Surface {
    std::vector<Bsdf> bsdfs;
    optics::PhaseSpectra spectra;
    spectral::WavelengthSet wavelengths;
    Lanes index_above = lanes(1.0), index_below = lanes(1.0);
    bool dispersive = false, hero_only = false;
    int hero = 5;

    Surface() {
        for (int k = 0; k < spectral::lane_count; ++k) {
            wavelengths.wavelength_nm[static_cast<std::size_t>(k)] = 400.0 + 20.0 * k;
        }
        wavelengths.interval_nm = wavelengths.luminance = wavelengths.x = wavelengths.z =
            lanes(1.0);
    }
    SpectrumId spectrum(const Lanes& values) {
        spectra.push_back(values);
        return static_cast<SpectrumId>(spectra.size() - 1);
    }
    BsdfId add(Bsdf bsdf) {
        bsdfs.push_back(std::move(bsdf));
        return static_cast<BsdfId>(bsdfs.size() - 1);
    }
    const Bsdf& bsdf() const { return bsdfs.back(); }
    optics::SurfaceOptics at() const {
        return {bsdfs, spectra, wavelengths, index_above, index_below, dispersive, hero_only, hero};
    }
};

inline Vec3 direction(double theta_deg, double phi_deg) {
    const double theta = theta_deg * pi / 180.0, phi = phi_deg * pi / 180.0;
    return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

}  // namespace lucerna::test
