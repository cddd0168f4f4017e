// Numbers of a scene file that are stated with an uncertainty, such as "0.7 ± 0.02".
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

namespace lucerna::io {

struct UncertainInput {
    std::string path;  ///< where it stands: "materials.wall.reflectance"
    int line = 0, column = 0;
    double value;
    double expanded_uncertainty;  ///< half width of the interval that holds it at 95 %
    std::string unit;             ///< base unit of both; "" for plain numbers
    double shift;  ///< the uncertainty, or minus that where a larger value would not be accepted
};

/// "materials.wall.reflectance: 0.7 ± 0.02"
inline std::string text_of(const UncertainInput& input) {
    return fmt::format("{}: {:g} ± {:g}{}{}", input.path, input.value, input.expanded_uncertainty,
                       input.unit.empty() ? "" : " ", input.unit);
}

/// Those of one reading of a file, of which one may be read as shifted by its uncertainty.
class UncertainInputs {
public:
    explicit UncertainInputs(std::string shifted = "") : shifted_(std::move(shifted)) {}

    /// Notes an input; returns the value that the scene shall have. A number that is read in
    /// several places, by an alias, is one input.
    double add(const UncertainInput& input) {
        auto known = std::find_if(list_.begin(), list_.end(), [&](const UncertainInput& other) {
            return other.line == input.line && other.column == input.column;
        });
        if (known == list_.end()) known = list_.insert(known, input);
        return known->path == shifted_ ? input.value + input.shift : input.value;
    }
    const std::vector<UncertainInput>& list() const { return list_; }

private:
    std::string shifted_;
    std::vector<UncertainInput> list_;
};

}  // namespace lucerna::io
