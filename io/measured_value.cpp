#include "io/measured_value.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace lucerna::io {
namespace {

// Power of ten of the leading digit once `value` is rounded to `digits` significant digits.
int leading_exponent(double value, int digits) {
    const std::string text = fmt::format("{:.{}e}", value, digits - 1);
    return std::stoi(text.substr(text.find('e') + 1));
}

}  // namespace

std::string measured_value(double value, double expanded_uncertainty) {
    if (!std::isfinite(expanded_uncertainty)) return fmt::format("{:.4g} ± unknown", value);
    if (expanded_uncertainty == 0.0) return fmt::format("{:.6g}", value);
    constexpr int digits = 2;  // of the uncertainty, JCGM 100:2008, 7.2.6
    const int last_place = leading_exponent(expanded_uncertainty, digits) - (digits - 1);
    const double size = std::max(std::abs(value), expanded_uncertainty);
    if (size >= 1e6 || size < 1e-3) {
        const int decimals = std::max(0, leading_exponent(size, digits) - last_place);
        return fmt::format("{:.{}e} ± {:.{}e}", value, decimals, expanded_uncertainty, digits - 1);
    }
    const double place = std::pow(10.0, last_place);
    const int decimals = std::max(0, -last_place);
    return fmt::format("{:.{}f} ± {:.{}f}", std::round(value / place) * place, decimals,
                       std::round(expanded_uncertainty / place) * place, decimals);
}

std::string byte_size(double bytes) {
    constexpr std::array units = {"B", "kB", "MB", "GB", "TB"};
    std::size_t unit = 0;
    while (bytes >= 999.5 && unit + 1 < units.size()) {
        bytes /= 1000.0;
        ++unit;
    }
    return fmt::format("{:.{}f} {}", bytes, unit == 0 || bytes >= 9.95 ? 0 : 1, units[unit]);
}

}  // namespace lucerna::io
