// Rays from the lights through the scene.
#pragma once

#include <functional>
#include <vector>

#include "optics/transport/emission.h"
#include "optics/transport/path.h"
#include "optics/transport/sensor_planes.h"

namespace lucerna::optics {

/// What a ray met between its light and the present surface.
enum class History : std::uint8_t {
    direct = 1,   ///< nothing
    caustic = 2,  ///< one specular event at least, no scattering
    indirect = 4  ///< one scattering event at least
};

/// Set of histories with one member; sets are or-ed.
constexpr std::uint8_t mask(History history) {
    return static_cast<std::uint8_t>(history);
}

/// A ray bundle from a light that arrives at a surface with scattering properties; it carries
/// spectral flux, not a quantum of energy.
struct Photon {
    SurfacePoint point;
    Vec3 direction;  ///< unit, along the flight of the light
    /// [W/nm] when divided by the number of rays of the trace. On planes of sensors, which read
    /// nothing else, X, Y and Z [lm]: wavelengths of photons there need not be those of the phase.
    Lanes flux;
    History history;
    bool on_common_lane = false;  ///< alone on it, see choose_common_hero()
    std::uint32_t light = 0;      ///< that it comes from
};

/// Luminous flux of a photon [lm].
/// @param luminance  weights of the wavelengths of its ray.
inline double luminous_flux(const Lanes& luminance, const Photon& photon) {
    return static_cast<double>(photon.point.object == no_object ? photon.flux[1]
                                                                : (photon.flux * luminance).sum());
}

/// Counts of a block of forward rays. All fluxes in lm, not yet divided by the number of rays.
struct ForwardTally {
    ForwardTally() = default;  ///< of no scene
    explicit ForwardTally(const SceneParts& parts)
        : absorbed_by_object(parts.objects.size(), 0.0),
          absorbed_by_solid(parts.objects.size(), 0.0),
          received_front(parts.objects.size(), 0.0),
          received_back(parts.objects.size(), 0.0) {}

    double emitted = 0.0, escaped = 0.0, trapped = 0.0, inconsistent = 0.0, numerical = 0.0;
    double residue = 0.0;
    std::vector<double> absorbed_by_object, absorbed_by_solid;  ///< on its surface, inside it
    std::vector<double> received_front, received_back;          ///< arrived on each side
    std::uint64_t segments = 0;

    void operator+=(const ForwardTally& other);
    /// Saves to an archive or loads from one.
    template <typename Archive>
    void serialize(Archive& archive) {
        archive(emitted, escaped, trapped, inconsistent, numerical, residue, absorbed_by_object,
                absorbed_by_solid, received_front, received_back, segments);
    }
};

/// How far forward rays are followed.
enum class Reach {
    first_scattering,  ///< the path ends there, and a guided ray that carries more flux than most
                       ///< goes both ways at smooth boundaries
    whole_path,
    whole_path_split  ///< leaves its first scattering event in several directions, each with its
                      ///< part of the flux: photons of indirect light for fewer rays
};

/// Number of directions in which a split path leaves its first scattering event.
inline constexpr std::uint32_t directions_of_split = 4;

/// Number of whole paths that take about as long as one of this reach: the way to the first
/// scattering event is paid for once.
constexpr std::uint32_t whole_paths_per_path(Reach reach) {
    return reach == Reach::whole_path_split ? 3 : 1;
}

/// Traces ray number `index` of a trace and gives every arrival at a scattering surface to
/// `arrive`. Rays are unbiased samples of the lights' flux; the sum over n rays divided by n
/// estimates it, split or not.
/// @param planes  virtual planes of sensors whose crossings count as arrivals too, or nullptr.
void trace_forward(const Phase& phase, const Emission& emission, std::uint32_t index, Reach reach,
                   const SensorPlanes* planes, ForwardTally& tally,
                   const std::function<void(const Photon&)>& arrive);

}  // namespace lucerna::optics
