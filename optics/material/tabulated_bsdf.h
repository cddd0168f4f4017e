// Isotropic BSDF tables over both polar angles, the difference of azimuth, and wavelength.
#pragma once

#include <optional>
#include <vector>

#include "core/sampling.h"
#include "optics/material/measured_parts.h"
#include "spectral/lanes.h"
#include "spectral/wavelength_set.h"

namespace lucerna::optics {

/// A full grid of measured values, in the order of its axes.
struct BsdfGrid {
    std::vector<double> theta_in_rad;   ///< polar angle of the light's arrival, within [0, pi/2]
    std::vector<double> theta_out_rad;  ///< polar angle of its leaving, within [0, pi/2]
    /// Azimuth of leaving minus azimuth of arrival, both of vectors that point away from the
    /// surface and counted counter-clockwise as seen from the front: pi is the plane of specular
    /// reflection. From 0 to pi (mirror symmetry), from 0 to 2 pi, or the single value 0 (no
    /// dependence).
    std::vector<double> delta_phi_rad;
    std::vector<double> wavelength_nm;
    /// [1/sr], finite, >= 0: index ((in * outs + out) * azimuths + azimuth) * wavelengths +
    /// wavelength.
    std::vector<double> bsdf_per_sr;
};

/// One part of a table, interpolated linearly in each angle and in wavelength. Beyond the ends of
/// an axis the value at the end is held.
class BsdfTable {
public:
    /// Throws std::invalid_argument unless every axis increases strictly and the azimuths are as
    /// said.
    explicit BsdfTable(const BsdfGrid& grid);

    /// f for light from `in` toward `out`, on either side of the surface [1/sr].
    spectral::Lanes bsdf_per_sr(const Vec3& in, const Vec3& out,
                                const spectral::WavelengthSet& wavelengths) const;
    /// Integral of the interpolant times cosine over the hemisphere of `out`, in closed form.
    double directional_hemispherical(double theta_in_rad, double wavelength_nm) const;

    /// Sampling of one end of a path: cells of the asked-for end's polar angle and of azimuth, in
    /// proportion to their corner values, averaged over wavelength, times projected solid angle;
    /// interpolated between the known end's grid angles.
    class CellSampler {
    public:
        CellSampler(std::vector<double> known_rad, std::vector<double> asked_rad,
                    std::vector<double> delta_phi_rad, std::vector<double> cell_mean);
        /// Estimate of the integral of f cos over the asked-for end.
        double total(double known_rad) const;
        /// Polar angle as sin^2, and difference of azimuth.
        struct Angles {
            double sin2_theta, delta_phi_rad;
        };
        Angles sample(double known_rad, double u_cell, double u1, double u2) const;
        /// Density per projected solid angle, times total() [1/sr].
        double weight(double known_rad, double theta_rad, double delta_phi_rad) const;

    private:
        std::vector<double> known_rad_, asked_rad_, delta_phi_rad_;
        std::vector<double>
            cell_mean_;  // [(known * asked cells + asked) * azimuth cells + azimuth]
        std::vector<DiscreteDistribution> cells_;  // per known angle; empty where all is 0
    };
    const CellSampler& outgoing() const { return outgoing_; }
    const CellSampler& incident() const { return incident_; }

    const std::vector<double>& theta_in_rad() const { return grid_.theta_in_rad; }
    const std::vector<double>& wavelength_nm() const { return grid_.wavelength_nm; }

private:
    BsdfGrid grid_;  // extended to whole axes
    CellSampler outgoing_, incident_;
};

/// A measured isotropic surface.
class TabulatedBsdf {
public:
    explicit TabulatedBsdf(MeasuredParts<BsdfTable> parts) : parts_(std::move(parts)) {}

    const MeasuredParts<BsdfTable>& parts() const { return parts_; }

    spectral::Lanes bsdf_per_sr(const Vec3& in, const Vec3& out,
                                const spectral::WavelengthSet& wavelengths) const;
    /// Reflectance plus transmittance for light from that side.
    double directional_hemispherical(Side light, double theta_in_rad, double wavelength_nm) const;

    std::optional<Vec3> sample(const Vec3& known, double u_lobe, double u1, double u2,
                               Transport transport) const;
    /// Probability that sample() keeps to the side of `known`, with u_lobe below it; 1 where f is
    /// 0.
    double reflection_probability(const Vec3& known, Transport transport) const;
    double pdf_solid_angle(const Vec3& known, const Vec3& sampled, Transport transport) const;

private:
    MeasuredParts<BsdfTable> parts_;
};

}  // namespace lucerna::optics
