// Scenes in a few lines: grey materials, equal-energy lights.
#pragma once

#include <string>

#include "optics/scene.h"
#include "spectral/photometry.h"

namespace lucerna::validation {

/// Adds parts with plain numbers to optics::SceneParts.
struct SceneBuilder {
    optics::SceneParts parts;

    optics::BsdfId diffuse(double reflectance, double transmittance = 0.0) {
        return parts.add(
            optics::Bsdf{optics::Diffuse{parts.add(spectral::Spectrum(reflectance)),
                                         parts.add(spectral::Spectrum(transmittance))}});
    }
    optics::BsdfId mirror(double reflectance) {
        return parts.add(optics::Bsdf{optics::Mirror{parts.add(spectral::Spectrum(reflectance))}});
    }
    optics::BsdfId black() { return parts.add(optics::Bsdf{optics::Black{}}); }
    optics::BsdfId smooth_dielectric() {
        return parts.add(optics::Bsdf{optics::SmoothDielectric{}});
    }

    optics::MediumId medium(double index, double absorption_per_m = 0.0, int priority = 0) {
        optics::Medium medium;
        medium.name = "medium";
        medium.index = parts.add(spectral::Spectrum(index));
        medium.absorption_per_m = parts.add(spectral::Spectrum(absorption_per_m));
        medium.absorbing = absorption_per_m > 0.0;
        medium.priority = priority;
        return parts.add(std::move(medium));
    }

    /// Without absorption.
    /// @param index_at  index(wavelength in nm), tabulated at each nanometre.
    template <typename Function>
    optics::MediumId dispersive_medium(const Function& index_at) {
        std::vector<double> wavelengths_nm, indices;
        for (double nm = spectral::min_wavelength_nm; nm <= spectral::max_wavelength_nm; ++nm) {
            wavelengths_nm.push_back(nm);
            indices.push_back(index_at(nm));
        }
        const optics::MediumId id = medium(1.0);
        parts.media[id].index =
            parts.add(spectral::Spectrum(wavelengths_nm, indices, spectral::Outside::hold));
        parts.media[id].dispersive = true;
        return id;
    }

    optics::ObjectId object(const std::string& name, optics::Shape shape, optics::BsdfId bsdf) {
        return parts.add(optics::Object{.name = name,
                                        .shape = std::move(shape),
                                        .front = bsdf,
                                        .back = bsdf,
                                        .interior = std::nullopt,
                                        .material = name,
                                        .up = std::nullopt});
    }
    optics::ObjectId solid(const std::string& name, optics::Shape shape, optics::MediumId medium) {
        const optics::ObjectId id = object(name, std::move(shape), smooth_dielectric());
        parts.objects[id].interior = medium;
        return id;
    }

    /// A light of equal-energy spectrum with the given luminous flux.
    void light(const std::string& name, optics::LightSource source, double luminous_flux_lm) {
        optics::Light light;
        light.name = name;
        light.source = std::move(source);
        light.luminous_flux_lm = luminous_flux_lm;
        light.flux_w_per_nm =
            parts.add(spectral::scaled_to_luminous(spectral::Spectrum(1.0), luminous_flux_lm));
        parts.lights.push_back(std::move(light));
    }
    /// Lambertian light on an object so that its surface has the given luminance [cd/m2].
    void area_light(optics::ObjectId object, double luminance, bool inward = false,
                    bool both_sides = false) {
        const optics::Shape& shape = parts.objects[object].shape;
        const double sides = both_sides ? 2.0 : 1.0;
        light(parts.objects[object].name, optics::AreaLight{object, shape, both_sides, inward},
              luminance * pi * optics::area_m2(shape) * sides);
    }

    void meter(const Vec3& position, const Vec3& target, double half_angle_rad) {
        parts.observers.push_back(optics::LuminanceMeter{
            "meter", position, (target - position).normalized(), half_angle_rad});
    }
    void points(std::vector<Vec3> positions, const Vec3& normal) {
        parts.observers.push_back(
            optics::IlluminancePoints{"points", std::move(positions), normal, 0, 0});
    }
    void camera(const Vec3& from, const Vec3& to, const Vec3& up, double fov_rad, int width,
                int height) {
        parts.observers.push_back(optics::Camera{"view", from, to, up, fov_rad, width, height});
    }
    void receiver(optics::ObjectId object) {
        parts.receivers.push_back({parts.objects[object].name, object});
    }

    /// The six inner faces of a box room [0, x] x [0, y] x [0, z], normals inward:
    /// -x, +x, -y, +y, -z, +z.
    static std::array<optics::Shape, 6> room(double x, double y, double z) {
        using optics::Rectangle;
        const Vec3 ex(x, 0, 0), ey(0, y, 0), ez(0, 0, z), o = Vec3::Zero();
        return {Rectangle{o, ey, ez},  Rectangle{ex, ez, ey}, Rectangle{o, ez, ex},
                Rectangle{ey, ex, ez}, Rectangle{o, ex, ey},  Rectangle{ez, ey, ex}};
    }
};

}  // namespace lucerna::validation
