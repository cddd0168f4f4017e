#include "spectral/spectrum.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace lucerna::spectral {
namespace {

// The node values that count on the simulated range, and the values at its two ends.
std::vector<double> values_in_range(const Spectrum& spectrum) {
    std::vector<double> values = {spectrum.at(min_wavelength_nm), spectrum.at(max_wavelength_nm)};
    for (std::size_t i = 0; i < spectrum.wavelengths_nm().size(); ++i) {
        const double wavelength_nm = spectrum.wavelengths_nm()[i];
        if (wavelength_nm >= min_wavelength_nm && wavelength_nm <= max_wavelength_nm) {
            values.push_back(spectrum.values()[i]);
        }
    }
    return values;
}

}  // namespace

Spectrum::Spectrum(double constant) : values_{constant} {
    if (!std::isfinite(constant)) throw std::invalid_argument("spectrum: value is not finite");
}

Spectrum::Spectrum(std::vector<double> wavelengths_nm, std::vector<double> values, Outside outside)
    : wavelengths_nm_(std::move(wavelengths_nm)), values_(std::move(values)), outside_(outside) {
    if (wavelengths_nm_.empty() || wavelengths_nm_.size() != values_.size()) {
        throw std::invalid_argument("spectrum: needs as many values as wavelengths, and some");
    }
    if (wavelengths_nm_.size() < 2 && outside_ == Outside::zero) {
        throw std::invalid_argument("spectrum: a single point that is zero elsewhere has no area");
    }
    const auto finite = [](double x) { return std::isfinite(x); };
    if (!std::all_of(wavelengths_nm_.begin(), wavelengths_nm_.end(), finite) ||
        !std::all_of(values_.begin(), values_.end(), finite)) {
        throw std::invalid_argument("spectrum: entry is not finite");
    }
    if (std::adjacent_find(wavelengths_nm_.begin(), wavelengths_nm_.end(),
                           std::greater_equal<>()) != wavelengths_nm_.end()) {
        throw std::invalid_argument("spectrum: wavelengths do not increase");
    }
}

double Spectrum::at(double wavelength_nm) const {
    if (is_constant()) return values_.front();
    if (wavelength_nm < wavelengths_nm_.front()) {
        return outside_ == Outside::zero ? 0.0 : values_.front();
    }
    if (wavelength_nm > wavelengths_nm_.back()) {
        return outside_ == Outside::zero ? 0.0 : values_.back();
    }
    const auto above =
        std::upper_bound(wavelengths_nm_.begin(), wavelengths_nm_.end(), wavelength_nm);
    if (above == wavelengths_nm_.end()) return values_.back();
    const auto i = static_cast<std::size_t>(above - wavelengths_nm_.begin());
    const double fraction =
        (wavelength_nm - wavelengths_nm_[i - 1]) / (wavelengths_nm_[i] - wavelengths_nm_[i - 1]);
    return std::lerp(values_[i - 1], values_[i], fraction);
}

double Spectrum::max() const {
    const std::vector<double> values = values_in_range(*this);
    return *std::max_element(values.begin(), values.end());
}

double Spectrum::min() const {
    const std::vector<double> values = values_in_range(*this);
    return *std::min_element(values.begin(), values.end());
}

Spectrum Spectrum::scaled(double factor) const {
    if (!std::isfinite(factor)) throw std::invalid_argument("spectrum: factor is not finite");
    Spectrum result = *this;
    for (double& value : result.values_) value *= factor;
    return result;
}

}  // namespace lucerna::spectral
