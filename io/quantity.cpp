#include "io/quantity.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

namespace lucerna::io {
namespace {

constexpr double degree = std::numbers::pi / 180.0;
constexpr Unit number_units[] = {{"", 1.0, ""}};
constexpr Unit length_units[] = {
    {"m", 1.0, "m"}, {"mm", 1e-3, "m"}, {"cm", 1e-2, "m"}, {"um", 1e-6, "m"}, {"km", 1e3, "m"}};
constexpr Unit angle_units[] = {{"deg", degree, "rad"}, {"rad", 1.0, "rad"}};
constexpr Unit wavelength_units[] = {{"nm", 1.0, "nm"}, {"um", 1e3, "nm"}};
constexpr Unit temperature_units[] = {{"K", 1.0, "K"}};
constexpr Unit time_units[] = {{"s", 1.0, "s"}, {"min", 60.0, "s"}, {"h", 3600.0, "s"}};
constexpr Unit flux_units[] = {
    {"lm", 1.0, "lm"}, {"klm", 1e3, "lm"}, {"mlm", 1e-3, "lm"}, {"W", 1.0, "W"}, {"mW", 1e-3, "W"}};
constexpr Unit luminous_flux_units[] = {{"lm", 1.0, "lm"}, {"klm", 1e3, "lm"}, {"mlm", 1e-3, "lm"}};
constexpr Unit intensity_units[] = {
    {"cd", 1.0, "cd"}, {"kcd", 1e3, "cd"}, {"mcd", 1e-3, "cd"}, {"W/sr", 1.0, "W/sr"}};
constexpr Unit luminance_units[] = {{"cd/m2", 1.0, "cd/m2"},
                                    {"cd/m^2", 1.0, "cd/m2"},
                                    {"cd/m²", 1.0, "cd/m2"},
                                    {"kcd/m2", 1e3, "cd/m2"},
                                    {"W/(m2 sr)", 1.0, "W/(m2 sr)"}};
constexpr Unit exitance_units[] = {{"lm/m2", 1.0, "lm/m2"}, {"lm/m^2", 1.0, "lm/m2"},
                                   {"lm/m²", 1.0, "lm/m2"}, {"W/m2", 1.0, "W/m2"},
                                   {"W/m^2", 1.0, "W/m2"},  {"W/m²", 1.0, "W/m2"}};
constexpr Unit irradiance_units[] = {{"lx", 1.0, "lx"},
                                     {"klx", 1e3, "lx"},
                                     {"W/m2", 1.0, "W/m2"},
                                     {"W/m^2", 1.0, "W/m2"},
                                     {"W/m²", 1.0, "W/m2"}};
constexpr Unit absorption_units[] = {
    {"1/m", 1.0, "1/m"}, {"1/cm", 1e2, "1/m"}, {"1/mm", 1e3, "1/m"}};
constexpr Unit fraction_units[] = {{"", 1.0, ""}, {"%", 1e-2, ""}};
constexpr Unit percent_units[] = {{"%", 1e-2, ""}};

}  // namespace

namespace dimension {

const Dimension number{"a number without unit", "0.5", number_units};
const Dimension length{"a length", "10 mm", length_units};
const Dimension angle{"an angle", "20 deg", angle_units};
const Dimension wavelength{"a wavelength", "555 nm", wavelength_units};
const Dimension temperature{"a temperature", "6500 K", temperature_units};
const Dimension time{"a time", "10 min", time_units};
const Dimension flux{"a flux", "1200 lm", flux_units};
const Dimension luminous_flux{"a luminous flux", "1200 lm", luminous_flux_units};
const Dimension intensity{"an intensity", "100 cd", intensity_units};
const Dimension luminance{"a luminance", "5000 cd/m2", luminance_units};
const Dimension exitance{"an exitance", "3000 lm/m2", exitance_units};
const Dimension irradiance{"an illuminance or irradiance", "500 lx", irradiance_units};
const Dimension absorption{"an absorption coefficient", "0.3 1/m", absorption_units};
const Dimension fraction{"a fraction", "0.7 or 70 %", fraction_units};
const Dimension percent{"a percentage", "2 %", percent_units};

}  // namespace dimension

namespace {

std::string_view trimmed(std::string_view text) {
    const auto first = text.find_first_not_of(" \t\r\n");
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1);
}

/// At most as much of what a user wrote as fits into a message.
std::string shortened(std::string_view text) {
    constexpr std::size_t longest = 60;
    return text.size() <= longest ? std::string(text)
                                  : std::string(text.substr(0, longest)) + "...";
}

/// "mm, cm or m"
std::string accepted_units(const Dimension& dimension) {
    std::string list;
    for (std::size_t i = 0; i < dimension.units.size(); ++i) {
        if (i > 0) list += i + 1 == dimension.units.size() ? " or " : ", ";
        const std::string_view symbol = dimension.units[i].symbol;
        list += symbol.empty() ? "no unit" : symbol;
    }
    return list;
}

}  // namespace

Quantity parse_quantity(std::string_view text, const Dimension& dimension) {
    const auto complain = [&](const std::string& what) -> std::invalid_argument {
        return std::invalid_argument(fmt::format("'{}' {}; expected {} such as \"{}\"",
                                                 shortened(trimmed(text)), what, dimension.name,
                                                 dimension.example));
    };
    std::string_view rest = trimmed(text);
    if (rest.empty()) throw complain("is empty");
    // from_chars() knows no plus sign; one before a minus sign stays, and is refused.
    if (rest.front() == '+' && !rest.starts_with("+-")) rest.remove_prefix(1);

    double number = 0.0;
    const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), number);
    if (error == std::errc::result_out_of_range) throw complain("is too large or too small");
    if (error != std::errc()) throw complain("is not a number");
    rest.remove_prefix(static_cast<std::size_t>(end - rest.data()));
    if (!std::isfinite(number)) throw complain("is not finite");
    if (!rest.empty() && rest.front() == ',')
        throw complain("has a decimal comma where a point belongs");

    rest = trimmed(rest);
    for (const Unit& unit : dimension.units) {
        if (unit.symbol != rest) continue;
        const double value = number * unit.factor;
        if (!std::isfinite(value)) throw complain("is too large");
        return {value, unit.base};
    }
    if (rest.empty()) throw complain("has no unit");
    if (dimension.units.size() == 1 && dimension.units.front().symbol.empty())
        throw complain(fmt::format("has the unit '{}'", shortened(rest)));
    throw complain(
        fmt::format("has the unit '{}', not {}", shortened(rest), accepted_units(dimension)));
}

UncertainQuantity parse_uncertain_quantity(std::string_view text, const Dimension& dimension) {
    for (const std::string_view sign : {"±", "+/-"}) {
        const auto at = text.find(sign);
        if (at == std::string_view::npos) continue;
        const Quantity quantity = parse_quantity(text.substr(0, at), dimension);
        const std::string_view stated = trimmed(text.substr(at + sign.size()));
        const bool in_percent = stated.ends_with('%');
        const auto has_percent = [](const Unit& unit) { return unit.symbol == "%"; };
        const bool relative =
            in_percent && std::none_of(dimension.units.begin(), dimension.units.end(), has_percent);
        Quantity uncertainty = parse_quantity(stated, relative ? dimension::percent : dimension);
        if (relative) {
            uncertainty = {uncertainty.value * std::abs(quantity.value), quantity.base};
        }
        if (uncertainty.value < 0.0) {
            throw std::invalid_argument(
                fmt::format("'{}' states a negative uncertainty", shortened(trimmed(text))));
        }
        if (uncertainty.base != quantity.base) {
            throw std::invalid_argument(
                fmt::format("'{}' has an uncertainty in {}; expected {} or %",
                            shortened(trimmed(text)), uncertainty.base, quantity.base));
        }
        return {quantity, uncertainty.value};
    }
    return {parse_quantity(text, dimension)};
}

double parse_value(std::string_view text, const Dimension& dimension) {
    return parse_quantity(text, dimension).value;
}

}  // namespace lucerna::io
