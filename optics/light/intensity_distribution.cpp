#include "optics/light/intensity_distribution.h"

#include <algorithm>
#include <stdexcept>

namespace lucerna::optics {
namespace {

// A linear function of gamma across one cell: `start` at its lower edge, `end` at its upper one.
struct GammaSegment {
    double gamma_rad;  // lower edge
    double height_rad;
    double start, end;

    double value(double x) const { return start + (end - start) * (x / height_rad); }

    // Integral of value(x) sin(gamma + x) from 0 to x, by parts; differences of cosines as
    // products.
    double integral(double x) const {
        const double half = std::sin(0.5 * x);
        const double cosines = 2.0 * std::sin(gamma_rad + 0.5 * x) * half;
        const double sines = 2.0 * std::cos(gamma_rad + 0.5 * x) * half;
        return start * cosines + (end - start) / height_rad * (sines - x * std::cos(gamma_rad + x));
    }

    double total() const { return std::max(0.0, integral(height_rad)); }

    // x at which the integral is the share u of its total: Newton's method inside a bracket.
    double inverse(double u) const {
        const double wanted = u * integral(height_rad);
        double low = 0.0;
        double high = height_rad;
        double x = u * height_rad;
        for (int i = 0; i < 100 && high - low > 1e-14 * height_rad; ++i) {
            const double error = integral(x) - wanted;
            (error > 0.0 ? high : low) = x;
            const double slope = value(x) * std::sin(gamma_rad + x);
            const double next = x - error / slope;
            const bool inside = next > low && next < high;  // false for an undefined step as well
            const double step = std::abs(next - x);
            x = inside ? next : 0.5 * (low + high);
            if (inside && step < 1e-14 * height_rad) break;
        }
        return x;
    }
};

// s in [0, 1] with density in proportion to a + (b - a) s.
double sample_linear(double a, double b, double u) {
    if (a == b) return u;
    // Root of the quadratic cdf without cancellation.
    const double root = std::sqrt(std::max(0.0, a * a + u * (b * b - a * a)));
    return std::clamp(u * (a + b) / (a + root), 0.0, 1.0);
}

void require(bool condition, const char* message) {
    if (!condition) throw std::invalid_argument(message);
}

bool strictly_increasing(const std::vector<double>& values) {
    // An undefined number is not less than its neighbour and so fails as well.
    for (std::size_t i = 1; i < values.size(); ++i) {
        if (!(values[i - 1] < values[i])) return false;
    }
    return true;
}

// Index of the interval of a grid that holds `value`, which lies within the grid.
std::size_t interval(const std::vector<double>& grid, double value) {
    const auto above = std::upper_bound(grid.begin() + 1, grid.end() - 1, value);
    return static_cast<std::size_t>(above - grid.begin()) - 1;
}

std::vector<double> radians(const std::vector<double>& degrees) {
    std::vector<double> result;
    for (const double value : degrees) result.push_back(value * rad_per_deg);
    return result;
}

}  // namespace

IntensityDistribution::IntensityDistribution(std::vector<double> c_deg,
                                             std::vector<double> gamma_deg,
                                             std::vector<std::vector<double>> intensity_cd)
    : c_deg_(std::move(c_deg)), gamma_deg_(std::move(gamma_deg)) {
    require(!c_deg_.empty() && c_deg_.front() == 0.0 &&
                (c_deg_.size() == 1 || c_deg_.back() == 360.0) && strictly_increasing(c_deg_),
            "C planes must increase from 0 to 360 degrees, or be the single plane 0");
    require(gamma_deg_.size() >= 2 && gamma_deg_.front() >= 0.0 && gamma_deg_.back() <= 180.0 &&
                strictly_increasing(gamma_deg_),
            "gamma angles must be two or more that increase within 0 to 180 degrees");
    require(intensity_cd.size() == c_deg_.size(), "one list of intensities per C plane");
    c_rad_ = radians(c_deg_);
    gamma_rad_ = radians(gamma_deg_);

    const std::size_t gammas = gamma_deg_.size();
    table_cd_.reserve(c_deg_.size() * gammas);
    for (std::size_t c = 0; c < c_deg_.size(); ++c) {
        require(intensity_cd[c].size() == gammas, "one intensity per gamma angle");
        for (std::size_t g = 0; g < gammas; ++g) {
            const double value = intensity_cd[c][g];
            require(value >= 0.0 && std::isfinite(value), "intensities must be finite and >= 0");
            table_cd_.push_back(value);
            if (value > max_cd_) {
                max_cd_ = value;
                max_c_deg_ = c_deg_[c];
                max_gamma_deg_ = gamma_deg_[g];
            }
        }
    }

    std::vector<double> fluxes;
    const std::size_t sectors = std::max<std::size_t>(1, c_deg_.size() - 1);
    for (std::size_t c = 0; c < sectors; ++c) {
        const std::size_t next = std::min(c + 1, c_deg_.size() - 1);
        const double width_rad = c_deg_.size() == 1 ? 2.0 * pi : c_rad_[next] - c_rad_[c];
        for (std::size_t g = 0; g + 1 < gammas; ++g) {
            // The mean over C of the bilinear interpolant is linear in gamma.
            const GammaSegment mean{gamma_rad_[g], gamma_rad_[g + 1] - gamma_rad_[g],
                                    0.5 * (at(c, g) + at(next, g)),
                                    0.5 * (at(c, g + 1) + at(next, g + 1))};
            fluxes.push_back(width_rad * mean.total());
        }
    }
    cells_ = DiscreteDistribution(fluxes);
}

Vec3 IntensityDistribution::direction(double c_deg, double gamma_deg) {
    const double c_rad = c_deg * rad_per_deg;
    const double gamma_rad = gamma_deg * rad_per_deg;
    return {std::sin(gamma_rad) * std::cos(c_rad), std::sin(gamma_rad) * std::sin(c_rad),
            -std::cos(gamma_rad)};
}

double IntensityDistribution::intensity_cd(const Vec3& direction) const {
    const double gamma =
        std::clamp(std::atan2(std::hypot(direction.x(), direction.y()), -direction.z()), 0.0, pi);
    // The edge of the table belongs to it, also when the direction was rounded.
    constexpr double rounding_rad = 1e-12;
    if (gamma < gamma_rad_.front() - rounding_rad || gamma > gamma_rad_.back() + rounding_rad) {
        return 0.0;
    }
    const std::size_t g = interval(gamma_rad_, gamma);
    const double t =
        std::clamp((gamma - gamma_rad_[g]) / (gamma_rad_[g + 1] - gamma_rad_[g]), 0.0, 1.0);
    const auto in_plane = [&](std::size_t c) { return (1.0 - t) * at(c, g) + t * at(c, g + 1); };
    if (c_rad_.size() == 1) return in_plane(0);

    double angle = std::atan2(direction.y(), direction.x());
    if (angle < 0.0) angle += 2.0 * pi;
    const std::size_t c = interval(c_rad_, angle);
    const double s = std::clamp((angle - c_rad_[c]) / (c_rad_[c + 1] - c_rad_[c]), 0.0, 1.0);
    return (1.0 - s) * in_plane(c) + s * in_plane(c + 1);
}

double IntensityDistribution::zonal_flux_lm(double gamma_from_deg, double gamma_to_deg) const {
    double flux_lm = 0.0;
    const std::size_t sectors = std::max<std::size_t>(1, c_rad_.size() - 1);
    for (std::size_t g = 0; g + 1 < gamma_rad_.size(); ++g) {
        const double from =
            std::clamp(gamma_from_deg * rad_per_deg, gamma_rad_[g], gamma_rad_[g + 1]);
        const double to = std::clamp(gamma_to_deg * rad_per_deg, gamma_rad_[g], gamma_rad_[g + 1]);
        if (!(from < to)) continue;
        for (std::size_t c = 0; c < sectors; ++c) {
            const std::size_t next = std::min(c + 1, c_rad_.size() - 1);
            const double width_rad = c_rad_.size() == 1 ? 2.0 * pi : c_rad_[next] - c_rad_[c];
            const GammaSegment mean{gamma_rad_[g], gamma_rad_[g + 1] - gamma_rad_[g],
                                    0.5 * (at(c, g) + at(next, g)),
                                    0.5 * (at(c, g + 1) + at(next, g + 1))};
            flux_lm += width_rad *
                       (mean.integral(to - gamma_rad_[g]) - mean.integral(from - gamma_rad_[g]));
        }
    }
    return flux_lm;
}

Vec3 IntensityDistribution::sample(double u1, double u2) const {
    double u_c = 0.0;
    const std::size_t cell = cells_.sample(u1, &u_c);
    const std::size_t rows = gamma_rad_.size() - 1;
    const std::size_t c = cell / rows;
    const std::size_t g = cell % rows;
    const std::size_t next = std::min(c + 1, c_rad_.size() - 1);

    // C from its marginal density in the cell, which is linear, then gamma on that meridian.
    GammaSegment segment{gamma_rad_[g], gamma_rad_[g + 1] - gamma_rad_[g], at(c, g), at(c, g + 1)};
    double s = u_c;
    if (next != c) {
        GammaSegment right = segment;
        right.start = at(next, g);
        right.end = at(next, g + 1);
        s = sample_linear(segment.total(), right.total(), u_c);
        segment.start += s * (right.start - segment.start);
        segment.end += s * (right.end - segment.end);
    }
    const double width_rad = next == c ? 2.0 * pi : c_rad_[next] - c_rad_[c];
    const double angle = c_rad_[c] + s * width_rad;
    const double gamma = segment.gamma_rad + segment.inverse(u2);
    return {std::sin(gamma) * std::cos(angle), std::sin(gamma) * std::sin(angle), -std::cos(gamma)};
}

double IntensityDistribution::pdf_solid_angle(const Vec3& direction) const {
    return intensity_cd(direction) / luminous_flux_lm();
}

}  // namespace lucerna::optics
