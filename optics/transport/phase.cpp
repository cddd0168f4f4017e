#include "optics/transport/phase.h"

namespace lucerna::optics {

Phase::Phase(const Stage& stage_, std::uint64_t seed_, std::uint32_t number_, std::uint32_t part)
    : stage(stage_),
      seed(seed_),
      number(number_),
      wavelengths(stage_.wavelengths().sample(seed_, number_, part)) {
    spectra.reserve(stage.parts().spectra.size());
    for (const spectral::Spectrum& spectrum : stage.parts().spectra) {
        spectra.push_back(wavelengths.at(spectrum));
    }
}

const Lanes& Phase::index(ObjectId acting_solid) const {
    if (acting_solid == no_object) return ones;
    const SceneParts& parts = stage.parts();
    return spectra[parts.media[*parts.objects[acting_solid].interior].index];
}

bool Phase::dispersive(ObjectId acting_solid) const {
    if (acting_solid == no_object) return false;
    const SceneParts& parts = stage.parts();
    return parts.media[*parts.objects[acting_solid].interior].dispersive;
}

bool Phase::absorbs(ObjectId acting_solid) const {
    if (acting_solid == no_object) return false;
    const SceneParts& parts = stage.parts();
    return parts.media[*parts.objects[acting_solid].interior].absorbing;
}

Lanes Phase::transmittance(ObjectId acting_solid, double length_m) const {
    if (!absorbs(acting_solid)) return Lanes::Ones();
    const SceneParts& parts = stage.parts();
    const Medium& medium = parts.media[*parts.objects[acting_solid].interior];
    return (spectra[medium.absorption_per_m] * static_cast<float>(-length_m)).exp();
}

}  // namespace lucerna::optics
