#include "spectral/wavelength_set.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/random.h"
#include "spectral/integral.h"
#include "spectral/observer.h"

namespace lucerna::spectral {
namespace {

constexpr double step_nm = 1.0;
constexpr int node_count = static_cast<int>((max_wavelength_nm - min_wavelength_nm) / step_nm) + 1;

double node_nm(int i) {
    return min_wavelength_nm + step_nm * i;
}

// Mean of a spectrum around a node, weighted by a triangle of +/- 1 nm, so that no line of the
// emission falls between the nodes.
double mean_around(const Spectrum& spectrum, int node) {
    const double centre_nm = node_nm(node);
    const Spectrum triangle({centre_nm - step_nm, centre_nm, centre_nm + step_nm}, {0.0, 1.0, 0.0},
                            Outside::zero);
    const double from_nm = std::max(min_wavelength_nm, centre_nm - step_nm);
    const double to_nm = std::min(max_wavelength_nm, centre_nm + step_nm);
    return integral_of_product(spectrum, triangle, from_nm, to_nm) /
           integral_of_product(1.0, triangle, from_nm, to_nm);
}

// Area under a piecewise linear function up to each node.
std::vector<double> running_integral(const std::vector<double>& values) {
    std::vector<double> areas(values.size(), 0.0);
    for (std::size_t i = 1; i < values.size(); ++i) {
        areas[i] = areas[i - 1] + 0.5 * step_nm * (values[i - 1] + values[i]);
    }
    return areas;
}

// Adds weight * values / area of values; nothing if the values are all zero.
void add_normalised(std::vector<double>& density, double weight,
                    const std::vector<double>& values) {
    const double area = running_integral(values).back();
    if (!(area > 0.0)) return;
    for (std::size_t i = 0; i < density.size(); ++i) density[i] += weight * values[i] / area;
}

}  // namespace

Lanes WavelengthSet::at(const Spectrum& spectrum) const {
    if (spectrum.is_constant()) return Lanes::Constant(static_cast<float>(spectrum.values()[0]));
    Lanes lanes;
    for (int k = 0; k < lane_count; ++k) {
        lanes[k] = static_cast<float>(spectrum.at(wavelength_nm[static_cast<std::size_t>(k)]));
    }
    return lanes;
}

WavelengthSampler::WavelengthSampler(const Spectrum& emission, Dispersion dispersion) {
    if (emission.min() < 0.0) throw std::invalid_argument("emission is negative");
    if (!(integral_of_product(emission, 1.0) > 0.0)) {
        throw std::invalid_argument("nothing is emitted between 360 nm and 830 nm");
    }
    std::vector<double> radiant;
    std::vector<double> photopic;
    std::vector<double> colour;
    for (int i = 0; i < node_count; ++i) {
        const double x = x_bar().at(node_nm(i));
        const double y = v_lambda().at(node_nm(i));
        const double z = z_bar().at(node_nm(i));
        radiant.push_back(mean_around(emission, i));
        photopic.push_back(radiant.back() * y);
        colour.push_back(radiant.back() * (x + y + z));
    }
    const bool hero_alone = dispersion == Dispersion::present;
    density_.assign(radiant.size(), 0.0);
    add_normalised(density_, hero_alone ? 0.80 : 0.40, photopic);
    add_normalised(density_, hero_alone ? 0.10 : 0.40, colour);
    add_normalised(density_, hero_alone ? 0.08 : 0.18, radiant);
    add_normalised(density_, 0.02, std::vector<double>(radiant.size(), 1.0));
    cumulative_ = running_integral(density_);
    for (double& value : density_) value /= cumulative_.back();
    cumulative_ = running_integral(density_);
}

WavelengthSet WavelengthSampler::sample(std::uint64_t seed, std::uint32_t phase,
                                        std::uint32_t part) const {
    RandomStream random(seed, phase, RandomPurpose::wavelengths, 0);
    // Multiples of 1 / x and 1 / x^2, x^3 = x + 1, are spread evenly over the square (M. Roberts,
    // "The unreasonable effectiveness of quasirandom sequences", 2018: R2).
    constexpr double inverse_root = 0.75487766624669276;
    const auto moved = [part](double u, double by) {
        const double sum = u + part * by;
        return sum - std::floor(sum);
    };
    const double shift = moved(random.uniform(), inverse_root);

    WavelengthSet set;
    set.first_common = static_cast<int>(moved(random.uniform(), inverse_root * inverse_root) * 2.0);
    for (int k = 0; k < lane_count; ++k) {
        const double wavelength_nm = quantile_nm((k + shift) / lane_count);
        const double interval_nm = 1.0 / (lane_count * pdf_per_nm(wavelength_nm));
        const double efficacy = max_luminous_efficacy_lm_per_w * interval_nm;
        set.wavelength_nm[static_cast<std::size_t>(k)] = wavelength_nm;
        set.interval_nm[k] = static_cast<float>(interval_nm);
        set.luminance[k] = static_cast<float>(efficacy * v_lambda().at(wavelength_nm));
        set.x[k] = static_cast<float>(efficacy * x_bar().at(wavelength_nm));
        set.z[k] = static_cast<float>(efficacy * z_bar().at(wavelength_nm));
    }
    return set;
}

double WavelengthSampler::pdf_per_nm(double wavelength_nm) const {
    if (!(wavelength_nm >= min_wavelength_nm && wavelength_nm <= max_wavelength_nm)) return 0.0;
    const double position = (wavelength_nm - min_wavelength_nm) / step_nm;
    const std::size_t i = std::min(static_cast<std::size_t>(position), density_.size() - 2);
    return std::lerp(density_[i], density_[i + 1], position - static_cast<double>(i));
}

// The wavelength below which the given probability lies.
double WavelengthSampler::quantile_nm(double probability) const {
    const auto above =
        std::upper_bound(cumulative_.begin() + 1, cumulative_.end() - 1, probability);
    const auto i = static_cast<std::size_t>(above - cumulative_.begin()) - 1;
    // Between nodes: d0 t + (d1 - d0) t^2 / 2 = q, solved for t in a form without cancellation.
    const double q = std::max(0.0, probability - cumulative_[i]) / step_nm;
    const double d0 = density_[i];
    const double d1 = density_[i + 1];
    const double t = 2.0 * q / (d0 + std::sqrt(std::max(0.0, d0 * d0 + 2.0 * (d1 - d0) * q)));
    return node_nm(static_cast<int>(i)) + step_nm * std::min(t, 1.0);
}

}  // namespace lucerna::spectral
