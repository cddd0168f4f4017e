// What uncertain inputs make of the values of a result.
#include "optics/transport/result.h"

namespace lucerna::optics {

double InputChanges::expanded_uncertainty() const {
    double square = 0.0;
    for (const double change : changes) square += change * change;
    return std::sqrt(square);
}

void add_input_change(Result& result, const std::string& input, const Result& shifted) {
    result.uncertain_inputs.push_back(input);
    for (std::size_t i = 0; i < result.quantities.size(); ++i) {
        Quantity& quantity = result.quantities[i];
        quantity.inputs.changes.push_back(shifted.quantities[i].result().value -
                                          quantity.result().value);
    }
    for (std::size_t i = 0; i < result.derived.size(); ++i) {
        DerivedQuantity& derived = result.derived[i];
        derived.inputs.changes.push_back(shifted.derived[i].result.value - derived.result.value);
    }
}

}  // namespace lucerna::optics
