// What all rays of one phase share: its wavelengths and the values of all spectra on them.
#pragma once

#include "optics/transport/stage.h"

namespace lucerna::optics {

struct Phase {
    /// @param part  0: the wavelengths that all rays of the phase share. Else those of some of its
    ///     rays which meet no other ones.
    Phase(const Stage& stage_, std::uint64_t seed_, std::uint32_t number_, std::uint32_t part = 0);

    const Stage& stage;
    std::uint64_t seed;
    std::uint32_t number;  ///< counts from 0
    spectral::WavelengthSet wavelengths;
    PhaseSpectra spectra;  ///< of the scene, by SpectrumId
    const Lanes ones = Lanes::Ones();
    /// Takes down each ray that is cast, for the benchmark; one thread only. Usually nullptr.
    std::vector<Ray>* ray_log = nullptr;

    /// Index of refraction of the medium in a solid; 1 in the surroundings.
    const Lanes& index(ObjectId acting_solid) const;
    bool dispersive(ObjectId acting_solid) const;
    /// Internal transmittance over a length; 1 in the surroundings.
    Lanes transmittance(ObjectId acting_solid, double length_m) const;
    bool absorbs(ObjectId acting_solid) const;

    /// Luminous quantity of spectral lanes: W/nm -> lm, W/(m2 sr nm) -> cd/m2.
    double luminous(const Lanes& spectral) const {
        return static_cast<double>((spectral * wavelengths.luminance).sum());
    }
    /// X, Y, Z of spectral lanes in the first three, Y as above.
    Lanes tristimulus(const Lanes& spectral) const {
        Lanes xyz = Lanes::Zero();
        xyz[0] = (spectral * wavelengths.x).sum();
        xyz[1] = (spectral * wavelengths.luminance).sum();
        xyz[2] = (spectral * wavelengths.z).sum();
        return xyz;
    }
};

}  // namespace lucerna::optics
