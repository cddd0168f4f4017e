#include "optics/transport/stage.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/diagnostics.h"
#include "spectral/photometry.h"

namespace lucerna::optics {
namespace {

std::vector<Shape> shapes_of(const SceneParts& parts) {
    std::vector<Shape> shapes;
    shapes.reserve(parts.objects.size());
    for (const Object& object : parts.objects) shapes.push_back(object.shape);
    return shapes;
}

// Sum of the spectral fluxes of all lights, on a 1 nm grid.
spectral::Spectrum total_emission(const SceneParts& parts) {
    std::vector<double> wavelengths_nm;
    std::vector<double> values;
    for (double nm = spectral::min_wavelength_nm; nm <= spectral::max_wavelength_nm; nm += 1.0) {
        double sum = 0.0;
        for (const Light& light : parts.lights) sum += parts.spectra[light.flux_w_per_nm].at(nm);
        wavelengths_nm.push_back(nm);
        values.push_back(sum);
    }
    return {std::move(wavelengths_nm), std::move(values), spectral::Outside::zero};
}

bool any_disperses(const SceneParts& parts) {
    return std::any_of(parts.media.begin(), parts.media.end(),
                       [](const Medium& medium) { return medium.dispersive; });
}

// Toward the side of +z, or of -z.
Glossy glossy_toward(const Bsdf& bsdf, double side, const spectral::WavelengthSampler& sampler) {
    if (std::holds_alternative<RoughConductor>(bsdf) ||
        std::holds_alternative<RoughDielectric>(bsdf)) {
        return {true, true};
    }
    const auto* measured = std::get_if<Measured>(&bsdf);
    if (!measured) return {};
    constexpr double most = 4.0;  // to gather from photons around the point
    constexpr double angle_rad = 40.0 * pi / 180.0;
    const Vec3 wo(std::sin(angle_rad), 0.0, side * std::cos(angle_rad));
    const auto wavelengths = sampler.sample(0, 0);
    const auto glossy = [&](bool reflection) {
        const double of_side = concentration(*measured->data, wo, reflection, wavelengths);
        return of_side == 0.0 || of_side > most;
    };
    return {glossy(true), glossy(false)};
}

std::vector<double> luminous_fluxes(const SceneParts& parts) {
    std::vector<double> fluxes;
    for (const Light& light : parts.lights) fluxes.push_back(light.luminous_flux_lm);
    return fluxes;
}

// Where illuminate() samples the area of the light, not the solid angle under which it is seen.
std::optional<Sphere> ball_around_unevenly_sampled(const LightSource& light) {
    const Shape* shape = nullptr;
    if (const auto* area = std::get_if<AreaLight>(&light)) {
        const bool outer_sphere =
            std::holds_alternative<Sphere>(area->shape) && !area->inward && !area->both_sides;
        if (outer_sphere || std::holds_alternative<Rectangle>(area->shape)) return std::nullopt;
        shape = &area->shape;
    } else if (const auto* lamp = std::get_if<Luminaire>(&light)) {
        if (lamp->object == no_object) return std::nullopt;
        shape = &lamp->opening.shape();
    }
    if (!shape) return std::nullopt;
    const Eigen::AlignedBox3d box = bounds(*shape);
    return Sphere{box.center(), 0.5 * box.diagonal().norm()};
}

const SceneParts& checked(const SceneParts& parts) {
    Diagnostics diagnostics;
    if (parts.lights.empty()) diagnostics.add({}, "the scene has no light; expected at least one");
    if (parts.objects.empty())
        diagnostics.add({}, "the scene has no object; expected at least one");
    if (parts.observers.empty() && parts.receivers.empty()) {
        diagnostics.add({}, "the scene has nothing that measures; expected a camera or a sensor");
    }
    for (const Light& light : parts.lights) {
        if (!(light.luminous_flux_lm > 0.0) || !std::isfinite(light.luminous_flux_lm)) {
            diagnostics.add({}, fmt::format("light \"{}\" has a luminous flux of {} lm; expected a "
                                            "positive number",
                                            light.name, light.luminous_flux_lm));
        }
    }
    for (const Object& object : parts.objects) {
        if (object.interior && !is_solid(object.shape)) {
            diagnostics.add({},
                            fmt::format("object \"{}\" has a medium inside but is not a closed, "
                                        "outward oriented solid",
                                        object.name));
        }
    }
    diagnostics.throw_if_any();
    return parts;
}

}  // namespace

Stage::Stage(const SceneParts& parts, std::optional<bool> polarisation)
    : parts_(checked(parts)),
      caster_(shapes_of(parts)),
      disperses_(any_disperses(parts)),
      wavelengths_(total_emission(parts),
                   disperses_ ? spectral::Dispersion::present : spectral::Dispersion::none),
      light_of_object_(parts.objects.size(), no_light),
      light_choice_(luminous_fluxes(parts)) {
    for (std::uint32_t i = 0; i < parts_.lights.size(); ++i) {
        const LightSource& source = parts_.lights[i].source;
        if (const auto ball = ball_around_unevenly_sampled(source)) {
            unevenly_sampled_.push_back(*ball);
        }
        const ObjectId object = emitting_object(source);
        if (object == no_object) continue;
        if (light_of_object_[object] != no_light) {
            throw InputError({}, fmt::format("object \"{}\" carries two lights; expected one",
                                             parts_.objects[object].name));
        }
        light_of_object_[object] = i;
    }
    const SpectrumId white = parts_.add(spectral::Spectrum(1.0));
    const SpectrumId none = parts_.add(spectral::Spectrum(0.0));
    white_diffuser_ = parts_.add(Bsdf{Diffuse{white, none}});
    follows_polarisation_ =
        polarisation.value_or(std::ranges::any_of(parts_.bsdfs, [](const Bsdf& bsdf) {
            return std::holds_alternative<SmoothDielectric>(bsdf) ||
                   std::holds_alternative<SmoothConductor>(bsdf);
        }));
    for (const Bsdf& bsdf : parts_.bsdfs) {
        scatters_.push_back(has_scattering_lobe(bsdf, parts_.bsdfs));
        const auto glossy = [&](double side) { return glossy_toward(bsdf, side, wavelengths_); };
        glossy_.push_back({glossy(1.0), glossy(-1.0)});
        is_specular_.push_back(has_specular_lobe(bsdf, parts_.bsdfs));
    }
    patch_offset_.push_back(0);
    for (ObjectId id = 0; id < parts_.objects.size(); ++id) {
        const Object& object = parts_.objects[id];
        const std::uint32_t patches = optics::patch_count(object.shape);
        patch_offset_.push_back(patch_offset_.back() + patches);
        for (std::uint32_t patch = 0; patch < patches; ++patch) {
            patch_areas_m2_.push_back(optics::patch_area_m2(object.shape, patch));
            plane_patches_.push_back(is_plane(object.shape, patch));
        }
        if (object.interior) {
            // Well outside of the surface, whose sides are for contains() to tell.
            const Eigen::AlignedBox3d box = bounds(object.shape);
            const Vec3 margin = Vec3::Constant(1e-6 * box.diagonal().norm());
            solids_.emplace_back(id, Eigen::AlignedBox3d(box.min() - margin, box.max() + margin));
        }
        for (const BsdfId side : {object.front, object.back}) {
            if (side == pass_through) {
                has_null_surfaces_ = true;
                continue;
            }
            has_scattering_ = has_scattering_ || scatters_[side];
            if (has_specular_lobe(parts_.bsdfs[side], parts_.bsdfs)) {
                has_caustics_ = true;
            }
        }
    }
    // A point stated on a surface is on its front side, whatever the rounding of both.
    for (Observer& observer : parts_.observers) {
        if (auto* points = std::get_if<IlluminancePoints>(&observer)) {
            for (Vec3& position : points->positions) position += nudge_m() * points->normal;
        }
    }
    // Where solids overlap, the surface of the weaker one inside the stronger does not act.
    has_null_surfaces_ = has_null_surfaces_ || solids_.size() > 1;
}

MediumStack Stage::media_at(const Vec3& point) const {
    MediumStack stack;
    for (const auto& [solid, box] : solids_) {
        if (!box.contains(point)) continue;  // most points are in none
        if (contains(parts_.objects[solid].shape, point) && !stack.enter(solid)) {
            throw InputError({}, "more than 12 transparent solids overlap in one point");
        }
    }
    return stack;
}

}  // namespace lucerna::optics
