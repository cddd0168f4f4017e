// A scene made ready for simulation: what does not change from phase to phase.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/sampling.h"
#include "optics/scene.h"
#include "optics/transport/medium_stack.h"
#include "spectral/wavelength_set.h"

namespace lucerna::optics {

inline constexpr std::uint32_t no_light = ~0u;

/// The light that a surface scatters toward one of its sides: whether what it reflects, and what it
/// transmits, comes from so few directions that few of the photons around a point are of use, or
/// none.
struct Glossy {
    bool reflection = false, transmission = false;
};

class Stage {
public:
    /// Throws InputError if the parts contradict each other.
    /// @param polarisation  whether paths carry it; without it where a surface polarises.
    explicit Stage(const SceneParts& parts, std::optional<bool> polarisation = std::nullopt);

    const SceneParts& parts() const { return parts_; }
    const RayCaster& caster() const { return caster_; }
    const spectral::WavelengthSampler& wavelengths() const { return wavelengths_; }

    /// The light on an object's surface, or no_light.
    std::uint32_t light_of(ObjectId object) const { return light_of_object_[object]; }
    /// Chooses lights in proportion to their luminous flux.
    const DiscreteDistribution& light_choice() const { return light_choice_; }
    /// Balls around the lights whose points are sampled by their area, with no regard to how large
    /// they look from the point that they illuminate.
    const std::vector<Sphere>& unevenly_sampled() const { return unevenly_sampled_; }

    /// Number of a patch among the patches of all objects.
    std::uint32_t patch_index(const SurfacePoint& p) const {
        return patch_offset_[p.object] + p.patch;
    }
    std::uint32_t patch_count() const { return patch_offset_.back(); }
    double patch_area_m2(std::uint32_t patch) const { return patch_areas_m2_[patch]; }
    /// See is_plane().
    bool patch_is_plane(std::uint32_t patch) const { return plane_patches_[patch]; }

    /// The virtual surface of illuminance points: Lambertian, reflectance 1.
    BsdfId white_diffuser() const { return white_diffuser_; }
    bool scatters(BsdfId bsdf) const { return scatters_[bsdf]; }
    /// Of what the BSDF scatters toward the side of +z, or the other.
    const Glossy& glossy(BsdfId bsdf, bool above) const { return glossy_[bsdf][above ? 0 : 1]; }
    /// Whether the BSDF has a specular lobe.
    bool is_specular(BsdfId bsdf) const { return is_specular_[bsdf]; }
    /// True if any surface scatters light.
    bool has_scattering() const { return has_scattering_; }
    /// True if light can reach a scattering surface by specular events only: else no caustic map.
    bool has_caustics() const { return has_caustics_; }
    /// True if paths carry the polarisation of their light from event to event.
    bool follows_polarisation() const { return follows_polarisation_; }
    /// True if the index of a medium depends on wavelength, so that paths split.
    bool disperses() const { return disperses_; }
    /// True if a straight line can cross surfaces that do not act on light.
    bool has_null_surfaces() const { return has_null_surfaces_; }

    /// The solids with a medium that hold the point.
    MediumStack media_at(const Vec3& point) const;

    /// A length that is small against the scene but far above rounding [m].
    double nudge_m() const { return 1e-8 * caster_.scene_radius_m(); }

private:
    SceneParts parts_;
    RayCaster caster_;
    bool disperses_;
    spectral::WavelengthSampler wavelengths_;
    std::vector<std::uint32_t> light_of_object_;
    DiscreteDistribution light_choice_;
    std::vector<Sphere> unevenly_sampled_;
    std::vector<std::uint32_t> patch_offset_;  // one more than objects
    std::vector<double> patch_areas_m2_;
    std::vector<bool> plane_patches_;
    std::vector<bool> scatters_, is_specular_;
    std::vector<std::array<Glossy, 2>> glossy_;
    std::vector<std::pair<ObjectId, Eigen::AlignedBox3d>> solids_;  // objects with an interior
    BsdfId white_diffuser_ = 0;
    bool has_scattering_ = false;
    bool has_caustics_ = false;
    bool has_null_surfaces_ = false;
    bool follows_polarisation_ = false;
};

}  // namespace lucerna::optics
