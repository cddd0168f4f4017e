// BSDF matrices on Klems bases, as LBNL WINDOW and Radiance genBSDF write them.
//
// Convention of azimuth. Klems azimuth is counted in one frame for both sides: x to the right and y
// up as seen from the back (the interior), z toward the back. Incident light is indexed by the
// azimuth of its propagation, outgoing light by that of its direction, so that straight
// transmission and specular reflection lie on the diagonal of a matrix. (Known from the interface
// of Radiance's BSDF library, whose "front" is WINDOW's "back".) Lucerna's local frame has z toward
// the front and y up: its x is the opposite of Klems's x.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/sampling.h"
#include "optics/material/klems_basis.h"
#include "optics/material/measured_parts.h"
#include "spectral/lanes.h"
#include "spectral/wavelength_set.h"

namespace lucerna::optics {

/// f between patches, constant on each pair of them; the same at all wavelengths.
class KlemsMatrix {
public:
    /// @param bsdf_per_sr  [incident patch * outgoing patches + outgoing patch], finite, >= 0.
    KlemsMatrix(KlemsBasis incident, KlemsBasis outgoing, std::vector<float> bsdf_per_sr);

    const KlemsBasis& incident() const { return incident_; }
    const KlemsBasis& outgoing() const { return outgoing_; }
    double bsdf_per_sr(int incident, int outgoing) const {
        return static_cast<double>(
            values_[static_cast<std::size_t>(incident * outgoing_.patch_count() + outgoing)]);
    }
    /// Outgoing patches for light on an incident patch, and incident patches for light that leaves
    /// on an outgoing one, in proportion to f times projected solid angle. total() is the
    /// directional-hemispherical reflectance or transmittance; with total() 0 it is empty.
    const DiscreteDistribution& forward(int incident) const {
        return forward_[static_cast<std::size_t>(incident)];
    }
    const DiscreteDistribution& backward(int outgoing) const {
        return backward_[static_cast<std::size_t>(outgoing)];
    }

    /// The matrix that reciprocity, f(a -> b) = f(b -> a), demands: of a reflection the same one,
    /// of a transmission that for light on the other side. Nothing if a basis has no opposite
    /// patches.
    std::optional<KlemsMatrix> reversed() const;

private:
    KlemsBasis incident_, outgoing_;
    std::vector<float> values_;
    std::vector<DiscreteDistribution> forward_, backward_;
};

/// A measured surface on Klems patches; wavelength-independent ("Visible").
class KlemsBsdf {
public:
    explicit KlemsBsdf(MeasuredParts<KlemsMatrix> parts) : parts_(std::move(parts)) {}

    const MeasuredParts<KlemsMatrix>& parts() const { return parts_; }

    /// f for light from `in` toward `out` (local frame, both away from the surface) [1/sr].
    double bsdf_per_sr(const Vec3& in, const Vec3& out) const;
    spectral::Lanes bsdf_per_sr(const Vec3& in, const Vec3& out,
                                const spectral::WavelengthSet&) const {
        return spectral::Lanes::Constant(static_cast<float>(bsdf_per_sr(in, out)));
    }
    /// Reflectance plus transmittance for light from `in`.
    double directional_hemispherical(const Vec3& in) const;

    /// Direction of the other end of a path whose one end is `known`, exactly in proportion to
    /// f |cos|; nothing if f is 0 there.
    std::optional<Vec3> sample(const Vec3& known, double u_lobe, double u1, double u2,
                               Transport transport) const;
    /// Probability that sample() keeps to the side of `known`, with u_lobe below it; 1 where f is
    /// 0.
    double reflection_probability(const Vec3& known, Transport transport) const;
    double pdf_solid_angle(const Vec3& known, const Vec3& sampled, Transport transport) const;
    /// The same three at once: the patches of both ends are looked for only once.
    struct Sample {
        Vec3 direction;
        double bsdf_per_sr, pdf_solid_angle;
    };
    std::optional<Sample> sample_with_density(const Vec3& known, double u_lobe, double u1,
                                              double u2, Transport transport) const;

private:
    MeasuredParts<KlemsMatrix> parts_;
};

}  // namespace lucerna::optics
