#include "optics/material/tabulated_bsdf.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "optics/material/bsdf.h"

namespace lucerna::optics {

namespace {

/// Where x lies on an axis: between nodes `lower` and `lower + 1`, at `fraction` of the way.
struct Position {
    std::size_t lower;
    double fraction;
};

Position locate(const std::vector<double>& axis, double x) {
    if (axis.size() < 2 || !(x > axis.front())) return {0, 0.0};
    if (x >= axis.back()) return {axis.size() - 2, 1.0};
    const auto above = std::upper_bound(axis.begin(), axis.end(), x);
    const auto lower = static_cast<std::size_t>(above - axis.begin()) - 1;
    return {lower, (x - axis[lower]) / (axis[lower + 1] - axis[lower])};
}

double polar_angle(const Vec3& d) {
    return std::atan2(std::hypot(d.x(), d.y()), std::abs(d.z()));
}

/// phi_out - phi_in in [0, 2 pi]. On the normal, where azimuth means nothing, it counts as 0.
double azimuth_difference(const Vec3& in, const Vec3& out) {
    const double angle = std::atan2(out.y(), out.x()) - std::atan2(in.y(), in.x());
    return angle < 0.0 ? angle + 2.0 * pi : angle;
}

void require_increasing(const std::vector<double>& axis) {
    if (axis.empty()) throw std::invalid_argument("an axis is empty");
    if (std::ranges::adjacent_find(axis, std::greater_equal<>()) != axis.end()) {
        throw std::invalid_argument("an axis does not increase strictly");
    }
}

/// The axis from `first` to `last`, and the index on the old axis that each node takes its value
/// of.
struct Extended {
    std::vector<double> axis;
    std::vector<std::size_t> source;
};

Extended extended_polar(const std::vector<double>& axis) {
    Extended result;
    const auto add = [&](double x, std::size_t source) {
        result.axis.push_back(x);
        result.source.push_back(source);
    };
    if (axis.front() > 0.0) add(0.0, 0);
    for (std::size_t i = 0; i < axis.size(); ++i) add(axis[i], i);
    if (axis.back() < 0.5 * pi) add(0.5 * pi, axis.size() - 1);
    return result;
}

Extended extended_azimuth(const std::vector<double>& axis) {
    constexpr double tolerance = 1e-9;
    if (axis.size() == 1) return {{0.0, 2.0 * pi}, {0, 0}};
    Extended result{axis, {}};
    for (std::size_t i = 0; i < axis.size(); ++i) result.source.push_back(i);
    const bool from_zero = std::abs(axis.front()) < tolerance;
    if (from_zero && std::abs(axis.back() - 2.0 * pi) < tolerance) return result;
    if (!from_zero || std::abs(axis.back() - pi) > tolerance) {
        throw std::invalid_argument("azimuths must reach from 0 to pi, or from 0 to 2 pi");
    }
    for (std::size_t i = axis.size() - 1; i-- > 0;) {
        result.axis.push_back(2.0 * pi - axis[i]);
        result.source.push_back(i);
    }
    return result;
}

/// The same grid with polar angles from 0 to pi/2 and azimuths from 0 to 2 pi.
BsdfGrid whole(const BsdfGrid& grid) {
    require_increasing(grid.theta_in_rad);
    require_increasing(grid.theta_out_rad);
    require_increasing(grid.delta_phi_rad);
    require_increasing(grid.wavelength_nm);
    const std::size_t outs = grid.theta_out_rad.size(), azimuths = grid.delta_phi_rad.size(),
                      wavelengths = grid.wavelength_nm.size();
    if (grid.bsdf_per_sr.size() != grid.theta_in_rad.size() * outs * azimuths * wavelengths) {
        throw std::invalid_argument("number of values does not fit the axes");
    }
    const Extended in = extended_polar(grid.theta_in_rad);
    const Extended out = extended_polar(grid.theta_out_rad);
    const Extended phi = extended_azimuth(grid.delta_phi_rad);
    BsdfGrid result{in.axis, out.axis, phi.axis, grid.wavelength_nm, {}};
    for (const std::size_t i : in.source) {
        for (const std::size_t o : out.source) {
            for (const std::size_t p : phi.source) {
                const std::size_t first = ((i * outs + o) * azimuths + p) * wavelengths;
                for (std::size_t w = 0; w < wavelengths; ++w) {
                    result.bsdf_per_sr.push_back(grid.bsdf_per_sr[first + w]);
                }
            }
        }
    }
    return result;
}

/// Sampler of the outgoing end (`forward`) or of the incident end of a whole grid.
BsdfTable::CellSampler cell_sampler(const BsdfGrid& grid, bool forward) {
    const auto& known = forward ? grid.theta_in_rad : grid.theta_out_rad;
    const auto& asked = forward ? grid.theta_out_rad : grid.theta_in_rad;
    const std::size_t outs = grid.theta_out_rad.size(), azimuths = grid.delta_phi_rad.size(),
                      wavelengths = grid.wavelength_nm.size();
    const auto node_sum = [&](std::size_t k, std::size_t a, std::size_t p) {
        const std::size_t in = forward ? k : a, out = forward ? a : k;
        double sum = 0.0;
        for (std::size_t w = 0; w < wavelengths; ++w) {
            sum += grid.bsdf_per_sr[((in * outs + out) * azimuths + p) * wavelengths + w];
        }
        return sum;
    };
    std::vector<double> cell_mean;
    for (std::size_t k = 0; k < known.size(); ++k) {
        for (std::size_t a = 0; a + 1 < asked.size(); ++a) {
            for (std::size_t p = 0; p + 1 < azimuths; ++p) {
                cell_mean.push_back((node_sum(k, a, p) + node_sum(k, a + 1, p) +
                                     node_sum(k, a, p + 1) + node_sum(k, a + 1, p + 1)) /
                                    (4.0 * static_cast<double>(wavelengths)));
            }
        }
    }
    return {known, asked, grid.delta_phi_rad, std::move(cell_mean)};
}

}  // namespace

BsdfTable::CellSampler::CellSampler(std::vector<double> known_rad, std::vector<double> asked_rad,
                                    std::vector<double> delta_phi_rad,
                                    std::vector<double> cell_mean)
    : known_rad_(std::move(known_rad)),
      asked_rad_(std::move(asked_rad)),
      delta_phi_rad_(std::move(delta_phi_rad)),
      cell_mean_(std::move(cell_mean)) {
    std::size_t next = 0;
    for (std::size_t k = 0; k < known_rad_.size(); ++k) {
        std::vector<double> weights;
        for (std::size_t a = 0; a + 1 < asked_rad_.size(); ++a) {
            const double ring =
                0.5 * (square(std::sin(asked_rad_[a + 1])) - square(std::sin(asked_rad_[a])));
            for (std::size_t p = 0; p + 1 < delta_phi_rad_.size(); ++p) {
                weights.push_back(cell_mean_[next++] * ring *
                                  (delta_phi_rad_[p + 1] - delta_phi_rad_[p]));
            }
        }
        const bool any = std::ranges::any_of(weights, [](double weight) { return weight > 0.0; });
        cells_.push_back(any ? DiscreteDistribution(weights) : DiscreteDistribution());
    }
}

double BsdfTable::CellSampler::total(double known_rad) const {
    const auto [k, t] = locate(known_rad_, known_rad);
    return std::lerp(cells_[k].total(), cells_[k + 1].total(), t);
}

BsdfTable::CellSampler::Angles BsdfTable::CellSampler::sample(double known_rad, double u_cell,
                                                              double u1, double u2) const {
    const auto [k, t] = locate(known_rad_, known_rad);
    const double lower_total = (1.0 - t) * cells_[k].total(),
                 upper_total = t * cells_[k + 1].total();
    const double scaled = u_cell * (lower_total + upper_total);
    const bool lower = scaled < lower_total;
    const double u = lower ? scaled / lower_total : (scaled - lower_total) / upper_total;
    const std::size_t cell =
        cells_[lower ? k : k + 1].sample(std::min(u, std::nextafter(1.0, 0.0)));
    const std::size_t azimuth_cells = delta_phi_rad_.size() - 1;
    const std::size_t a = cell / azimuth_cells, p = cell % azimuth_cells;
    return {std::lerp(square(std::sin(asked_rad_[a])), square(std::sin(asked_rad_[a + 1])), u1),
            std::lerp(delta_phi_rad_[p], delta_phi_rad_[p + 1], u2)};
}

double BsdfTable::CellSampler::weight(double known_rad, double theta_rad,
                                      double delta_phi_rad) const {
    const auto [k, t] = locate(known_rad_, known_rad);
    const std::size_t azimuth_cells = delta_phi_rad_.size() - 1;
    const std::size_t cells = (asked_rad_.size() - 1) * azimuth_cells;
    const std::size_t cell = locate(asked_rad_, theta_rad).lower * azimuth_cells +
                             locate(delta_phi_rad_, delta_phi_rad).lower;
    return std::lerp(cell_mean_[k * cells + cell], cell_mean_[(k + 1) * cells + cell], t);
}

BsdfTable::BsdfTable(const BsdfGrid& grid)
    : grid_(whole(grid)),
      outgoing_(cell_sampler(grid_, true)),
      incident_(cell_sampler(grid_, false)) {}

spectral::Lanes BsdfTable::bsdf_per_sr(const Vec3& in, const Vec3& out,
                                       const spectral::WavelengthSet& wavelengths) const {
    const std::size_t outs = grid_.theta_out_rad.size(), azimuths = grid_.delta_phi_rad.size(),
                      spectrum_size = grid_.wavelength_nm.size();
    const Position i = locate(grid_.theta_in_rad, polar_angle(in));
    const Position o = locate(grid_.theta_out_rad, polar_angle(out));
    const Position p = locate(grid_.delta_phi_rad, azimuth_difference(in, out));
    // The eight corners of the cell: where their spectrum starts, and their weight.
    std::array<std::size_t, 8> first;
    std::array<double, 8> weight;
    for (std::size_t corner = 0; corner < 8; ++corner) {
        const std::size_t di = corner & 1, dout = corner >> 1 & 1, dp = corner >> 2 & 1;
        first[corner] =
            (((i.lower + di) * outs + o.lower + dout) * azimuths + p.lower + dp) * spectrum_size;
        weight[corner] = (di ? i.fraction : 1.0 - i.fraction) *
                         (dout ? o.fraction : 1.0 - o.fraction) *
                         (dp ? p.fraction : 1.0 - p.fraction);
    }
    const auto at_node = [&](std::size_t w) {
        double sum = 0.0;
        for (std::size_t corner = 0; corner < 8; ++corner) {
            sum += weight[corner] * grid_.bsdf_per_sr[first[corner] + w];
        }
        return sum;
    };
    if (spectrum_size == 1) return spectral::Lanes::Constant(static_cast<float>(at_node(0)));
    spectral::Lanes f;
    for (int k = 0; k < spectral::lane_count; ++k) {
        const auto [w, t] =
            locate(grid_.wavelength_nm, wavelengths.wavelength_nm[static_cast<std::size_t>(k)]);
        f[k] = static_cast<float>(std::lerp(at_node(w), at_node(w + 1), t));
    }
    return f;
}

double BsdfTable::directional_hemispherical(double theta_in_rad, double wavelength_nm) const {
    const std::size_t outs = grid_.theta_out_rad.size(), azimuths = grid_.delta_phi_rad.size(),
                      spectrum_size = grid_.wavelength_nm.size();
    const Position i = locate(grid_.theta_in_rad, theta_in_rad);
    const Position w = locate(grid_.wavelength_nm, wavelength_nm);
    const auto node = [&](std::size_t in, std::size_t out, std::size_t phi) {
        const double* spectrum =
            &grid_.bsdf_per_sr[((in * outs + out) * azimuths + phi) * spectrum_size];
        return spectrum_size == 1 ? spectrum[0]
                                  : std::lerp(spectrum[w.lower], spectrum[w.lower + 1], w.fraction);
    };
    // Over azimuth the trapezoid is exact for the interpolant.
    const auto over_azimuth = [&](std::size_t out) {
        double sum = 0.0;
        for (std::size_t p = 0; p + 1 < azimuths; ++p) {
            for (const std::size_t phi : {p, p + 1}) {
                sum += 0.5 * (grid_.delta_phi_rad[p + 1] - grid_.delta_phi_rad[p]) *
                       std::lerp(node(i.lower, out, phi), node(i.lower + 1, out, phi), i.fraction);
            }
        }
        return sum;
    };
    double result = 0.0;
    for (std::size_t o = 0; o + 1 < outs; ++o) {
        // Integral of (a + b theta) sin cos = [-(a + b theta) cos(2 theta) / 4 + b sin(2 theta) /
        // 8]
        const double t0 = grid_.theta_out_rad[o], t1 = grid_.theta_out_rad[o + 1];
        const double f0 = over_azimuth(o), f1 = over_azimuth(o + 1);
        const double slope = (f1 - f0) / (t1 - t0);
        result += 0.25 * (f0 * std::cos(2.0 * t0) - f1 * std::cos(2.0 * t1)) +
                  0.125 * slope * (std::sin(2.0 * t1) - std::sin(2.0 * t0));
    }
    return result;
}

namespace {

/// What can be at the other end of a path that is known at one end.
struct Lobes {
    bool forward;  ///< light arrives from the known end
    double known_rad;
    const BsdfTable* reflection;
    const BsdfTable* transmission;

    Lobes(const MeasuredParts<BsdfTable>& parts, const Vec3& known, Transport transport)
        : forward(transport == Transport::flux),
          known_rad(polar_angle(known)),
          reflection(parts.reflected(side_of(known))),
          transmission(parts.transmitted(forward ? side_of(known) : other(side_of(known)))) {}

    const BsdfTable::CellSampler& sampler(const BsdfTable& table) const {
        return forward ? table.outgoing() : table.incident();
    }
    double total(const BsdfTable* table) const {
        return table ? sampler(*table).total(known_rad) : 0.0;
    }
};

}  // namespace

spectral::Lanes TabulatedBsdf::bsdf_per_sr(const Vec3& in, const Vec3& out,
                                           const spectral::WavelengthSet& wavelengths) const {
    const BsdfTable* table = parts_.between(in, out);
    return table ? table->bsdf_per_sr(in, out, wavelengths) : spectral::Lanes::Zero();
}

double TabulatedBsdf::directional_hemispherical(Side light, double theta_in_rad,
                                                double wavelength_nm) const {
    double sum = 0.0;
    for (const BsdfTable* table : {parts_.reflected(light), parts_.transmitted(light)}) {
        if (table) sum += table->directional_hemispherical(theta_in_rad, wavelength_nm);
    }
    return sum;
}

std::optional<Vec3> TabulatedBsdf::sample(const Vec3& known, double u_lobe, double u1, double u2,
                                          Transport transport) const {
    const Lobes lobes(parts_, known, transport);
    const double reflected = lobes.total(lobes.reflection);
    const double transmitted = lobes.total(lobes.transmission);
    if (!(reflected + transmitted > 0.0)) return std::nullopt;
    const double scaled = u_lobe * (reflected + transmitted);
    const bool reflects = scaled < reflected;
    const double u_cell = reflects ? scaled / reflected : (scaled - reflected) / transmitted;
    const auto [sin2, delta_phi] =
        lobes.sampler(reflects ? *lobes.reflection : *lobes.transmission)
            .sample(lobes.known_rad, std::min(u_cell, std::nextafter(1.0, 0.0)), u1, u2);
    const double phi = std::atan2(known.y(), known.x()) + (lobes.forward ? delta_phi : -delta_phi);
    const double sin_theta = std::sqrt(sin2), cos_theta = std::sqrt(std::max(0.0, 1.0 - sin2));
    const bool up = (side_of(known) == Side::front) == reflects;
    return Vec3(sin_theta * std::cos(phi), sin_theta * std::sin(phi), up ? cos_theta : -cos_theta);
}

double TabulatedBsdf::reflection_probability(const Vec3& known, Transport transport) const {
    const Lobes lobes(parts_, known, transport);
    const double reflected = lobes.total(lobes.reflection);
    const double total = reflected + lobes.total(lobes.transmission);
    return total > 0.0 ? reflected / total : 1.0;
}

double TabulatedBsdf::pdf_solid_angle(const Vec3& known, const Vec3& sampled,
                                      Transport transport) const {
    const Lobes lobes(parts_, known, transport);
    const double total = lobes.total(lobes.reflection) + lobes.total(lobes.transmission);
    const bool reflects = side_of(known) == side_of(sampled);
    const BsdfTable* table = reflects ? lobes.reflection : lobes.transmission;
    if (!table || !(total > 0.0)) return 0.0;
    const double delta_phi =
        lobes.forward ? azimuth_difference(known, sampled) : azimuth_difference(sampled, known);
    return lobes.sampler(*table).weight(lobes.known_rad, polar_angle(sampled), delta_phi) *
           std::abs(sampled.z()) / total;
}

}  // namespace lucerna::optics
