#include "optics/material/klems_bsdf.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <stdexcept>

#include "optics/material/bsdf.h"

namespace lucerna::optics {

namespace {

/// Local directions in the frame of the basis, and back (the maps are their own inverse but for the
/// side): see the convention in the header.
Vec3 incident_in_basis(const Vec3& in) {
    return {in.x(), -in.y(), std::abs(in.z())};
}
Vec3 outgoing_in_basis(const Vec3& out) {
    return {-out.x(), out.y(), std::abs(out.z())};
}

DiscreteDistribution distribution(std::span<const double> weights) {
    const bool any = std::ranges::any_of(weights, [](double weight) { return weight > 0.0; });
    return any ? DiscreteDistribution(weights) : DiscreteDistribution();
}

/// What can be at the other end of a path that is known at one end.
struct Lobe {
    const KlemsMatrix* matrix = nullptr;
    int known_patch = 0;
    const DiscreteDistribution* patches = nullptr;
    double total = 0.0;

    Lobe(const KlemsMatrix* matrix_, const KlemsDirection& known, bool forward) : matrix(matrix_) {
        if (!matrix) return;
        known_patch = (forward ? matrix->incident() : matrix->outgoing()).patch(known);
        patches = forward ? &matrix->forward(known_patch) : &matrix->backward(known_patch);
        total = patches->total();
    }

    double bsdf_per_sr(const Vec3& other, bool forward) const {
        if (!matrix) return 0.0;
        if (forward) {
            return matrix->bsdf_per_sr(known_patch,
                                       matrix->outgoing().patch(outgoing_in_basis(other)));
        }
        return matrix->bsdf_per_sr(matrix->incident().patch(incident_in_basis(other)), known_patch);
    }
};

struct Lobes {
    bool forward;  ///< light arrives from the known end
    Side side;     ///< of the known end
    KlemsDirection known;
    Lobe reflection, transmission;

    Lobes(const MeasuredParts<KlemsMatrix>& parts, const Vec3& known_end, Transport transport)
        : forward(transport == Transport::flux),
          side(side_of(known_end)),
          known(forward ? incident_in_basis(known_end) : outgoing_in_basis(known_end)),
          reflection(parts.reflected(side), known, forward),
          transmission(parts.transmitted(forward ? side : other(side)), known, forward) {}

    double total() const { return reflection.total + transmission.total; }

    /// f with the other end, and the density with which that is sampled, both 1/sr; total() > 0.
    double bsdf_per_sr(const Vec3& end) const {
        return (side_of(end) == side ? reflection : transmission).bsdf_per_sr(end, forward);
    }
    double pdf_solid_angle(const Vec3& end, double bsdf_per_sr) const {
        return bsdf_per_sr * std::abs(end.z()) / total();
    }
};

}  // namespace

KlemsMatrix::KlemsMatrix(KlemsBasis incident, KlemsBasis outgoing, std::vector<float> bsdf_per_sr)
    : incident_(std::move(incident)),
      outgoing_(std::move(outgoing)),
      values_(std::move(bsdf_per_sr)) {
    const int ni = incident_.patch_count(), no = outgoing_.patch_count();
    if (values_.size() != static_cast<std::size_t>(ni) * static_cast<std::size_t>(no)) {
        throw std::invalid_argument("number of values does not fit the bases");
    }
    const auto distributions = [](int from_count, int to_count, auto weight) {
        std::vector<DiscreteDistribution> result;
        std::vector<double> weights(static_cast<std::size_t>(to_count));
        for (int from = 0; from < from_count; ++from) {
            for (int to = 0; to < to_count; ++to) {
                weights[static_cast<std::size_t>(to)] = weight(from, to);
            }
            result.push_back(distribution(weights));
        }
        return result;
    };
    forward_ = distributions(ni, no, [&](int i, int o) {
        return this->bsdf_per_sr(i, o) * outgoing_.projected_solid_angle_sr(o);
    });
    backward_ = distributions(no, ni, [&](int o, int i) {
        return this->bsdf_per_sr(i, o) * incident_.projected_solid_angle_sr(i);
    });
}

std::optional<KlemsMatrix> KlemsMatrix::reversed() const {
    const int ni = incident_.patch_count(), no = outgoing_.patch_count();
    std::vector<float> values(values_.size());
    for (int i = 0; i < ni; ++i) {
        for (int o = 0; o < no; ++o) {
            // The reversed light arrives from where it left, and propagates the other way.
            const auto new_incident = outgoing_.opposite(o), new_outgoing = incident_.opposite(i);
            if (!new_incident || !new_outgoing) return std::nullopt;
            values[static_cast<std::size_t>(*new_incident * ni + *new_outgoing)] =
                values_[static_cast<std::size_t>(i * no + o)];
        }
    }
    return KlemsMatrix(outgoing_, incident_, std::move(values));
}

double KlemsBsdf::bsdf_per_sr(const Vec3& in, const Vec3& out) const {
    const KlemsMatrix* matrix = parts_.between(in, out);
    if (!matrix) return 0.0;
    return matrix->bsdf_per_sr(matrix->incident().patch(incident_in_basis(in)),
                               matrix->outgoing().patch(outgoing_in_basis(out)));
}

double KlemsBsdf::directional_hemispherical(const Vec3& in) const {
    return Lobes(parts_, in, Transport::flux).total();
}

std::optional<KlemsBsdf::Sample> KlemsBsdf::sample_with_density(const Vec3& known, double u_lobe,
                                                                double u1, double u2,
                                                                Transport transport) const {
    const Lobes lobes(parts_, known, transport);
    if (!(lobes.total() > 0.0)) return std::nullopt;
    const double scaled = u_lobe * lobes.total();
    const bool reflects = scaled < lobes.reflection.total;
    const Lobe& lobe = reflects ? lobes.reflection : lobes.transmission;
    const double u_patch =
        reflects ? scaled / lobe.total : (scaled - lobes.reflection.total) / lobe.total;
    const int patch =
        static_cast<int>(lobe.patches->sample(std::min(u_patch, std::nextafter(1.0, 0.0))));
    const KlemsBasis& basis = lobes.forward ? lobe.matrix->outgoing() : lobe.matrix->incident();
    const Vec3 b = basis.sample(patch, u1, u2);
    const double z = (lobes.side == Side::front) == reflects ? b.z() : -b.z();
    const Vec3 end = lobes.forward ? Vec3(-b.x(), b.y(), z) : Vec3(b.x(), -b.y(), z);
    const double f = lobes.bsdf_per_sr(end);
    return Sample{end, f, lobes.pdf_solid_angle(end, f)};
}

std::optional<Vec3> KlemsBsdf::sample(const Vec3& known, double u_lobe, double u1, double u2,
                                      Transport transport) const {
    const auto sampled = sample_with_density(known, u_lobe, u1, u2, transport);
    return sampled ? std::optional(sampled->direction) : std::nullopt;
}

double KlemsBsdf::reflection_probability(const Vec3& known, Transport transport) const {
    const Lobes lobes(parts_, known, transport);
    return lobes.total() > 0.0 ? lobes.reflection.total / lobes.total() : 1.0;
}

double KlemsBsdf::pdf_solid_angle(const Vec3& known, const Vec3& sampled,
                                  Transport transport) const {
    const Lobes lobes(parts_, known, transport);
    if (!(lobes.total() > 0.0)) return 0.0;
    return lobes.pdf_solid_angle(sampled, lobes.bsdf_per_sr(sampled));
}

}  // namespace lucerna::optics
