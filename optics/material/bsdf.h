// Scattering at surfaces: the bidirectional scattering distribution function (BSDF).
//
// Conventions. Directions are unit vectors in the local frame whose z axis is the geometric normal
// of the surface, and point away from it. `wo` is the direction already known (toward the previous
// vertex of the path), `wi` the one asked for or sampled. A BSDF value f is in 1/sr and does not
// contain the cosine.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <variant>
#include <vector>

#include "core/vector.h"
#include "optics/material/measured_bsdf.h"
#include "optics/material/polarisation.h"
#include "spectral/lanes.h"
#include "spectral/spectrum.h"
#include "spectral/wavelength_set.h"

namespace lucerna::optics {

using spectral::Lanes;

/// Index into the spectra of the scene; their values on the lanes of a phase are in PhaseSpectra.
using SpectrumId = std::uint32_t;
using PhaseSpectra = std::vector<Lanes, Eigen::aligned_allocator<Lanes>>;
/// Index into the BSDFs of the scene.
using BsdfId = std::uint32_t;

/// Absorbs everything.
struct Black {};
/// Lambertian reflection and transmission: f = reflectance / pi on the side of wo, transmittance /
/// pi on the other. reflectance + transmittance <= 1 at every wavelength.
struct Diffuse {
    SpectrumId reflectance;
    SpectrumId transmittance;
};
/// Specular reflection with a reflectance that does not depend on the angle.
struct Mirror {
    SpectrumId reflectance;
};
/// Smooth metal: specular reflection by Fresnel's equations with complex index n + ik.
struct SmoothConductor {
    SpectrumId n, k;
};
/// Rough metal: GGX microfacets (Walter et al. 2007; visible normals: Heitz 2018), single
/// scattering.
struct RoughConductor {
    SpectrumId n, k;
    double roughness;  ///< GGX alpha, > 0
};
/// Smooth boundary between two media: specular reflection and refraction. The indices of refraction
/// come from the media on both sides (SurfaceOptics), not from here.
struct SmoothDielectric {};
/// Rough boundary between two media: GGX microfacets, single scattering.
struct RoughDielectric {
    double roughness;  ///< GGX alpha, > 0
};
/// A measured BSDF; `data` is shared by all phases.
struct Measured {
    std::shared_ptr<const MeasuredBsdf> data;
};
/// Weighted sum of other BSDFs; weights >= 0, sum <= 1 (the rest is absorbed).
struct Mixture {
    struct Component {
        double weight;
        BsdfId bsdf;
    };
    std::vector<Component> components;
};

/// Closed list: a missing case is a compile error.
using Bsdf = std::variant<Black, Diffuse, Mirror, SmoothConductor, RoughConductor, SmoothDielectric,
                          RoughDielectric, Measured, Mixture>;

/// What travels along the path; matters where the index of refraction changes.
enum class Transport {
    radiance,  ///< backward, from the observer: a refraction scales by (n_wo / n_wi)^2
    flux       ///< forward, from the light: no scaling
};

/// What a BSDF needs to know of the place where it is evaluated.
struct SurfaceOptics {
    const std::vector<Bsdf>& bsdfs;  ///< of the scene, for mixtures
    const PhaseSpectra& spectra;     ///< spectra of the scene on the lanes of this phase
    const spectral::WavelengthSet& wavelengths;
    const Lanes& index_above;  ///< index of refraction on the side of +z
    const Lanes& index_below;  ///< and on the side of -z
    bool dispersive = false;   ///< an index differs between the lanes
    bool hero_only = false;    ///< only the hero lane of this path still counts
    int hero = 0;              ///< the path's hero lane
    /// State of the light that arrives, its axis across the plane of incidence; sample() turns it
    /// into that of the light that goes on. nullptr: light counts as unpolarised at each event.
    Polarisation* polarisation = nullptr;
};

/// One sampled event.
struct BsdfSample {
    Vec3 wi;
    Lanes weight;           ///< f |cos| / density, divided by the probability of the lobe chosen
    bool specular = false;  ///< a delta lobe; then pdf_solid_angle is 0 and not used
    double pdf_solid_angle = 0.0;  ///< density of wi among all scattering lobes, [1/sr]
    /// With which a boundary chose this event; the weight has been divided by it.
    double probability = 1.0;
    /// The refraction differed between wavelengths: all lanes but the hero are 0 in `weight`, the
    /// hero's is multiplied by lane_count if the path carried all lanes before.
    bool hero_only = false;
};

/// The u_lobe that give the two events of a smooth boundary, for callers that follow both.
inline constexpr double one_event = 0.0, other_event = 1.0 - 0x1p-32;

/// f of the scattering (not specular) lobes [1/sr]; 0 where there are none. `transport` matters for
/// transmission between media only; f then includes the (n_wo / n_wi)^2 of radiance.
Lanes evaluate(const Bsdf& bsdf, const SurfaceOptics& at, const Vec3& wo, const Vec3& wi,
               Transport transport);

/// Density with which sample() chooses wi by a scattering lobe, times the probability that it
/// chooses a scattering lobe at all [1/sr].
double pdf_solid_angle(const Bsdf& bsdf, const SurfaceOptics& at, const Vec3& wo, const Vec3& wi,
                       Transport transport);

/// Samples one event in proportion to f |cos|; nothing if all light from wo is absorbed.
/// Unbiased: E[weight * g(wi)] = sum over lobes of the integral of f |cos| g. With mean weight
/// equal to the albedo; the caller decides by roulette whether the path goes on.
/// Specular events act on the polarisation of the path; all scattering lobes, rough boundaries
/// included, count as depolarising.
std::optional<BsdfSample> sample(const Bsdf& bsdf, const SurfaceOptics& at, const Vec3& wo,
                                 double u_lobe, double u1, double u2, Transport transport);

/// Two kinds of events between which sample() chooses by u_lobe alone: reflection and transmission
/// of a sheet, or scattering and specular events of a mixture.
struct EventSplit {
    double first = 1.0;  ///< probability of the first kind, which the u_lobe below it stand for
    bool by_side = false;

    bool has_both() const { return first > 0.0 && first < 1.0; }
    /// Of the kind to which the scattered direction wi belongs.
    double probability_of(const Vec3& wo, const Vec3& wi) const {
        return by_side && wo.z() * wi.z() < 0.0 ? 1.0 - first : first;
    }
};
EventSplit event_split(const Bsdf& bsdf, const SurfaceOptics& at, const Vec3& wo,
                       Transport transport);

/// Whether the BSDF has lobes of the kind at all (for the scene's maps and light choice).
bool has_specular_lobe(const Bsdf& bsdf, const std::vector<Bsdf>& bsdfs);
bool has_scattering_lobe(const Bsdf& bsdf, const std::vector<Bsdf>& bsdfs);
/// True if light can pass through the surface.
bool transmits(const Bsdf& bsdf, const std::vector<Bsdf>& bsdfs,
               const std::vector<spectral::Spectrum>& spectra);

}  // namespace lucerna::optics
