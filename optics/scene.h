// A scene: immutable parts by integer id, and the ray caster over its objects.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "optics/detector/detector.h"
#include "optics/geometry/ray_caster.h"
#include "optics/geometry/shape.h"
#include "optics/light/light.h"
#include "optics/material/bsdf.h"
#include "optics/material/medium.h"
#include "spectral/spectrum.h"

namespace lucerna::optics {

/// Sentinel: light passes the object's surface unchanged (a virtual sheet for a receiver).
inline constexpr BsdfId pass_through = ~0u;

struct Object {
    std::string name;
    Shape shape;
    BsdfId front = 0;                  ///< on the side of the normal, or pass_through
    BsdfId back = 0;                   ///< on the other side
    std::optional<MediumId> interior;  ///< for solids of a transparent medium
    std::string material;              ///< name of the material, for the flux balance
    /// Orients an anisotropic BSDF: its local y axis is `up` projected onto the surface.
    std::optional<Vec3> up;
};

/// The parts of a scene as a file or a test states them.
struct SceneParts {
    std::vector<spectral::Spectrum> spectra;
    std::vector<Bsdf> bsdfs;
    std::vector<Medium> media;
    std::vector<Object> objects;
    std::vector<Light> lights;
    std::vector<Observer> observers;
    std::vector<FluxReceiver> receivers;

    SpectrumId add(spectral::Spectrum spectrum);
    BsdfId add(Bsdf bsdf);
    MediumId add(Medium medium);
    ObjectId add(Object object);
};

}  // namespace lucerna::optics
