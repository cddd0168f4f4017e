#include "optics/material/bsdf.h"

#include <algorithm>

#include "optics/material/models.h"

namespace lucerna::optics {

Lanes evaluate(const Bsdf& bsdf, const SurfaceOptics& at, const Vec3& wo, const Vec3& wi,
               Transport transport) {
    return std::visit(
        [&]<typename Model>(const Model& model) -> Lanes {
            if constexpr (specular_only<Model>) {
                return Lanes::Zero();
            } else {
                return evaluate(model, at, wo, wi, transport);
            }
        },
        bsdf);
}

double pdf_solid_angle(const Bsdf& bsdf, const SurfaceOptics& at, const Vec3& wo, const Vec3& wi,
                       Transport transport) {
    return std::visit(
        [&]<typename Model>(const Model& model) -> double {
            if constexpr (specular_only<Model>) {
                return 0.0;
            } else {
                return pdf_solid_angle(model, at, wo, wi, transport);
            }
        },
        bsdf);
}

std::optional<BsdfSample> sample(const Bsdf& bsdf, const SurfaceOptics& at, const Vec3& wo,
                                 double u_lobe, double u1, double u2, Transport transport) {
    auto event = std::visit(
        [&]<typename Model>(const Model& model) -> std::optional<BsdfSample> {
            if constexpr (std::is_same_v<Model, Black>) {
                return std::nullopt;
            } else {
                return sample(model, at, wo, EventNumbers{u_lobe, u1, u2}, transport);
            }
        },
        bsdf);
    if (at.polarisation && event && !event->specular) at.polarisation->depolarise();
    return event;
}

EventSplit event_split(const Bsdf& bsdf, const SurfaceOptics& at, const Vec3& wo,
                       Transport transport) {
    if (const auto* diffuse = std::get_if<Diffuse>(&bsdf)) {
        return {reflection_probability(*diffuse, at), true};
    }
    if (const auto* measured = std::get_if<Measured>(&bsdf)) {
        return {reflection_probability(*measured, wo, transport), true};
    }
    if (const auto* mixture = std::get_if<Mixture>(&bsdf)) {
        return {scattering_probability(*mixture, at.bsdfs), false};
    }
    return {};
}

namespace {

template <typename Predicate>
bool any_component(const Mixture& mixture, const std::vector<Bsdf>& bsdfs, Predicate holds) {
    return std::ranges::any_of(mixture.components, [&](const Mixture::Component& component) {
        return component.weight > 0.0 && holds(bsdfs[component.bsdf]);
    });
}

}  // namespace

bool has_specular_lobe(const Bsdf& bsdf, const std::vector<Bsdf>& bsdfs) {
    if (const auto* mixture = std::get_if<Mixture>(&bsdf)) {
        return any_component(*mixture, bsdfs,
                             [&](const Bsdf& part) { return has_specular_lobe(part, bsdfs); });
    }
    return std::visit(
        []<typename Model>(const Model&) {
            return specular_only<Model> && !std::is_same_v<Model, Black>;
        },
        bsdf);
}

bool has_scattering_lobe(const Bsdf& bsdf, const std::vector<Bsdf>& bsdfs) {
    if (const auto* mixture = std::get_if<Mixture>(&bsdf)) {
        return any_component(*mixture, bsdfs,
                             [&](const Bsdf& part) { return has_scattering_lobe(part, bsdfs); });
    }
    return std::visit([]<typename Model>(const Model&) { return !specular_only<Model>; }, bsdf);
}

bool transmits(const Bsdf& bsdf, const std::vector<Bsdf>& bsdfs,
               const std::vector<spectral::Spectrum>& spectra) {
    if (const auto* mixture = std::get_if<Mixture>(&bsdf)) {
        return any_component(*mixture, bsdfs,
                             [&](const Bsdf& part) { return transmits(part, bsdfs, spectra); });
    }
    if (const auto* diffuse = std::get_if<Diffuse>(&bsdf)) {
        return spectra[diffuse->transmittance].max() > 0.0;
    }
    if (const auto* measured = std::get_if<Measured>(&bsdf)) return transmits(*measured->data);
    return std::holds_alternative<SmoothDielectric>(bsdf) ||
           std::holds_alternative<RoughDielectric>(bsdf);
}

}  // namespace lucerna::optics
