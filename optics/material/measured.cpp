// Measured data as a BSDF: which end of the path the light comes from, and the weight of a sample.
#include <cmath>

#include "optics/material/models.h"

namespace lucerna::optics {

Lanes evaluate(const Measured& measured, const SurfaceOptics& at, const Vec3& wo, const Vec3& wi,
               Transport transport) {
    const bool from_wi = transport == Transport::radiance;
    return std::visit(
        [&](const auto& data) {
            return data.bsdf_per_sr(from_wi ? wi : wo, from_wi ? wo : wi, at.wavelengths);
        },
        measured.data->data);
}

double pdf_solid_angle(const Measured& measured, const SurfaceOptics&, const Vec3& wo,
                       const Vec3& wi, Transport transport) {
    return std::visit([&](const auto& data) { return data.pdf_solid_angle(wo, wi, transport); },
                      measured.data->data);
}

double reflection_probability(const Measured& measured, const Vec3& wo, Transport transport) {
    return std::visit([&](const auto& data) { return data.reflection_probability(wo, transport); },
                      measured.data->data);
}

std::optional<BsdfSample> sample(const Measured& measured, const SurfaceOptics& at, const Vec3& wo,
                                 const EventNumbers& u, Transport transport) {
    BsdfSample event;
    Lanes f;
    if (const auto* klems = std::get_if<KlemsBsdf>(&measured.data->data)) {
        const auto sampled = klems->sample_with_density(wo, u.lobe, u.u1, u.u2, transport);
        if (!sampled) return std::nullopt;
        event.wi = sampled->direction;
        event.pdf_solid_angle = sampled->pdf_solid_angle;
        f = Lanes::Constant(static_cast<float>(sampled->bsdf_per_sr));
    } else {
        const auto& table = std::get<TabulatedBsdf>(measured.data->data);
        const auto wi = table.sample(wo, u.lobe, u.u1, u.u2, transport);
        if (!wi) return std::nullopt;
        event.wi = *wi;
        event.pdf_solid_angle = table.pdf_solid_angle(wo, *wi, transport);
        f = evaluate(measured, at, wo, *wi, transport);
    }
    if (!(event.pdf_solid_angle > 0.0)) return std::nullopt;  // wi rounded onto the horizon
    event.weight = f * static_cast<float>(std::abs(event.wi.z()) / event.pdf_solid_angle);
    return event;
}

bool is_isotropic(const MeasuredBsdf& measured) {
    return std::holds_alternative<TabulatedBsdf>(measured.data);
}

double concentration(const MeasuredBsdf& measured, const Vec3& wo, bool reflection,
                     const spectral::WavelengthSet& wavelengths) {
    // Midpoints of cells of equal projected solid angle, as large as the least of Klems patches.
    constexpr int rings = 128, sectors = 96;
    const bool above = (side_of(wo) == Side::front) == reflection;
    double sum = 0.0, squares = 0.0;
    for (int ring = 0; ring < rings; ++ring) {
        const double sin2 = (ring + 0.5) / rings, cos_theta = std::sqrt(1.0 - sin2);
        for (int sector = 0; sector < sectors; ++sector) {
            const double phi = 2.0 * pi * (sector + 0.5) / sectors;
            const Vec3 wi(std::sqrt(sin2) * std::cos(phi), std::sqrt(sin2) * std::sin(phi),
                          above ? cos_theta : -cos_theta);
            const Lanes f =
                std::visit([&](const auto& data) { return data.bsdf_per_sr(wi, wo, wavelengths); },
                           measured.data);
            sum += static_cast<double>(f.mean());
            squares += square(static_cast<double>(f.mean()));
        }
    }
    return sum > 0.0 ? squares * rings * sectors / square(sum) : 0.0;
}

bool transmits(const MeasuredBsdf& measured) {
    return std::visit(
        [](const auto& data) {
            const auto& transmission = data.parts().transmission;
            return transmission[0].has_value() || transmission[1].has_value();
        },
        measured.data);
}

}  // namespace lucerna::optics
