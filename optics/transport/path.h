// One path of light, forward or backward: from encounter to encounter with surfaces.
#pragma once

#include <optional>

#include "core/stratified.h"
#include "optics/transport/phase.h"

namespace lucerna::optics {

struct Path {
    Ray ray;
    SurfacePoint start;      ///< where the ray leaves; object == no_object in free space
    MediumStack media;       ///< the solids that hold the current segment
    Lanes weight;            ///< forward: spectral flux [W/nm]; backward: throughput
    bool hero_only = false;  ///< behind a dispersive refraction only the hero lane counts
    int hero = 0;            ///< that lane; each path has its own
    std::uint32_t lossless_events = 0;  ///< in a row
    /// Backward paths carry the state of light sent along them from the observer: reciprocity makes
    /// it the adjoint of the state of the light that comes the other way.
    Polarisation polarisation{};
};

/// The hero of a path that is all alone, such as one that brings flux to a receiver: all lanes are
/// as likely, so that light behind dispersive boundaries has all wavelengths within a phase.
inline int choose_hero(double u) {
    return static_cast<int>(u * spectral::lane_count);
}

/// The hero of a path that has to meet one of the other direction, both behind a dispersive
/// boundary: one of the phase's common lanes. As they are half of all, such paths have the same
/// lane twice as often; the luminance of half of the lanes varies from phase to phase by 2 to 5 %.
inline int choose_common_hero(const Phase& phase, double u) {
    constexpr int common = spectral::lane_count / 2;
    return phase.wavelengths.first_common + 2 * static_cast<int>(u * common);
}

/// What two such paths bring together counts with this weight: each pair of equal lanes is twice as
/// likely as if their heroes were independent.
inline constexpr float weight_of_common_heroes = 0.5f;

/// A surface at the end of a segment, before the path reacts to it.
struct Encounter {
    SurfacePoint point;
    Lanes transmittance;         ///< internal, of the segment that led here
    BsdfId bsdf = pass_through;  ///< of the side that the path meets; pass_through: does not act
    Frame frame;                 ///< local frame of the BSDF, z along the normal
    Vec3 wo;                     ///< local direction back along the path
    ObjectId medium_above = no_object, medium_below = no_object;  ///< acting solids on both sides
    MediumStack media_beyond;  ///< behind the surface, seen from the path
    bool consistent = true;    ///< false: leaves a solid never entered, or enters one twice
};

/// The next surface along the path, or nothing if the path leaves the scene.
std::optional<Encounter> next_encounter(const Phase& phase, const Path& path);

/// The frame in which an object's BSDF is stated at a surface point.
Frame bsdf_frame(const Phase& phase, const SurfacePoint& point);

/// What the BSDF at an encounter needs to know.
SurfaceOptics optics_at(const Phase& phase, ObjectId medium_above, ObjectId medium_below,
                        bool hero_only, int hero);
/// The same for an event of a path, with its polarisation where that is followed.
SurfaceOptics optics_at(const Phase& phase, const Encounter& encounter, Path& path);

/// Crosses a surface that does not act on light.
void pass(Path& path, const Encounter& encounter);

/// Leaves the encounter in the sampled direction; the weight is multiplied by the sample's.
void follow(Path& path, const Encounter& encounter, const BsdfSample& sample);

/// Largest of the lanes that still count on the path.
inline float live_max(const Path& path, const Lanes& lanes) {
    return path.hero_only ? lanes[path.hero] : lanes.maxCoeff();
}

/// Whether a path goes on after an event. Unbiased but for `trapped`, which is reported.
enum class Fate { goes_on, ended_by_roulette, trapped };

/// Russian roulette after an event that multiplied the weight by `factor` (largest live lane): the
/// path survives with probability min(1, factor) and is scaled up accordingly.
///
/// A path that loses nothing is never ended by that. From 1024 events in a row without loss on, it
/// is halved at each power of two by roulette, and after 2^16 such events its light is declared
/// trapped: a lossless solid holds it for ever, up to one part in 10^5 of leakage per event.
Fate roulette(Path& path, float factor, RandomStream& random);

inline constexpr std::uint32_t first_lossless_roulette = 1024;
inline constexpr std::uint32_t trapped_after_events = 1u << 16;

}  // namespace lucerna::optics
