// A ray with its state of polarisation, as fields in space (Jones calculus in three dimensions).
#pragma once

#include <array>
#include <complex>
#include <optional>

#include "core/vector.h"
#include "validation/truth/fresnel.h"

namespace lucerna::truth {

/// Light of any state of polarisation as the incoherent sum of two fields that are fully polarised;
/// the fields are scaled so that their squares add up to the flux of the ray.
struct PolarisedRay {
    Vec3 direction;
    std::array<Eigen::Vector3cd, 2> fields;

    double flux() const { return fields[0].squaredNorm() + fields[1].squaredNorm(); }

    static PolarisedRay unpolarised(const Vec3& direction, double flux) {
        const Vec3 across = direction.unitOrthogonal();
        const double amplitude = std::sqrt(0.5 * flux);
        return {direction,
                {(amplitude * across).cast<std::complex<double>>(),
                 (amplitude * direction.cross(across)).cast<std::complex<double>>()}};
    }
};

struct SplitRay {
    PolarisedRay reflected;
    std::optional<PolarisedRay> refracted;  ///< nothing at total reflection
};

/// Reflects and refracts at a smooth boundary. What is not reflected is refracted, and refraction
/// leaves the phases of s and p alike (the amplitudes of Born and Wolf, 7th ed., 1.5.2, eq. 20a,
/// are positive).
/// @param normal  of the boundary, unit, on either side.
inline SplitRay split_at_boundary(const PolarisedRay& ray, const Vec3& normal, double index_from,
                                  double index_to) {
    const Vec3 along = ray.direction.dot(normal) < 0.0 ? Vec3(-normal) : normal;
    const double cosine = std::min(1.0, ray.direction.dot(along));
    const Reflection fresnel = reflection(index_from, index_to, cosine);
    const Vec3 cross = ray.direction.cross(along);
    const Vec3 s = cross.norm() > 1e-12 ? Vec3(cross.normalized()) : along.unitOrthogonal();

    const auto turn = [&](const Vec3& direction, std::complex<double> factor_s,
                          std::complex<double> factor_p) {
        PolarisedRay turned{direction, {}};
        const Vec3 p_from = ray.direction.cross(s);
        const Vec3 p_to = direction.cross(s);
        for (std::size_t i = 0; i < 2; ++i) {
            turned.fields[i] =
                s * (factor_s * s.cast<std::complex<double>>().dot(ray.fields[i])) +
                p_to * (factor_p * p_from.cast<std::complex<double>>().dot(ray.fields[i]));
        }
        return turned;
    };

    SplitRay split{turn((ray.direction - 2.0 * cosine * along).normalized(), fresnel.amplitude_s,
                        fresnel.amplitude_p),
                   std::nullopt};
    if (fresnel.cosine_refracted > 0.0) {
        const double relative = index_from / index_to;
        const Vec3 direction =
            (relative * (ray.direction - cosine * along) + fresnel.cosine_refracted * along)
                .normalized();
        split.refracted = turn(direction, std::sqrt(1.0 - fresnel.reflectance_s()),
                               std::sqrt(1.0 - fresnel.reflectance_p()));
    }
    return split;
}

}  // namespace lucerna::truth
