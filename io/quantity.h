// Numbers with units, as a user writes them: "1200 lm", "10 mm", "2 %".
#pragma once

#include <optional>
#include <span>
#include <string_view>

namespace lucerna::io {

/// A unit: one of it is `factor` of `base`.
struct Unit {
    std::string_view symbol;
    double factor;
    std::string_view base;
};

/// What a number may measure, and the units in which it may be written.
struct Dimension {
    std::string_view name;     ///< with its article: "a length"
    std::string_view example;  ///< "10 mm"
    std::span<const Unit> units;
};

/// A value in its base unit.
struct Quantity {
    double value;
    std::string_view base;
};

namespace dimension {
extern const Dimension number;         ///< no unit
extern const Dimension length;         ///< m
extern const Dimension angle;          ///< rad
extern const Dimension wavelength;     ///< nm
extern const Dimension temperature;    ///< K
extern const Dimension time;           ///< s
extern const Dimension flux;           ///< lm or W
extern const Dimension luminous_flux;  ///< lm
extern const Dimension intensity;      ///< cd or W/sr
extern const Dimension luminance;      ///< cd/m2 or W/(m2 sr)
extern const Dimension exitance;       ///< lm/m2 or W/m2
extern const Dimension irradiance;     ///< lx or W/m2
extern const Dimension absorption;     ///< 1/m
extern const Dimension fraction;       ///< a plain number or percent -> 1
extern const Dimension percent;        ///< percent, the sign required -> 1
}  // namespace dimension

/// Reads a finite number with a unit of the dimension. Throws std::invalid_argument with a message
/// that names what was found and what would be accepted.
Quantity parse_quantity(std::string_view text, const Dimension& dimension);

/// A value that may have been stated with its uncertainty.
struct UncertainQuantity {
    Quantity quantity;
    std::optional<double> expanded_uncertainty{};  ///< in the base unit, not negative
};

/// The same for "1200 lm ± 60 lm" or "1200 lm ± 5 %", where +/- stands for ± as well. The
/// uncertainty has a unit of the dimension; a percentage is one of the value, unless the dimension
/// is one of fractions: "70 % ± 2 %" is 0.70 ± 0.02.
UncertainQuantity parse_uncertain_quantity(std::string_view text, const Dimension& dimension);

/// A quantity where the dimension has one base unit.
double parse_value(std::string_view text, const Dimension& dimension);

}  // namespace lucerna::io
