// Gauss-Legendre quadrature.
#pragma once

#include <array>

namespace lucerna::truth {

/// Integral of f from a to b by `panels` panels of eight nodes each (Abramowitz and Stegun, table
/// 25.4): exact for polynomials of degree 15 on each panel.
template <typename Function>
double integral(const Function& f, double a, double b, int panels = 8) {
    constexpr std::array<double, 4> nodes{0.183434642495650, 0.525532409916329, 0.796666477413627,
                                          0.960289856497536};
    constexpr std::array<double, 4> weights{0.362683783378362, 0.313706645877887, 0.222381034453374,
                                            0.101228536290376};
    const double half = 0.5 * (b - a) / panels;
    double sum = 0.0;
    for (int panel = 0; panel < panels; ++panel) {
        const double middle = a + (2 * panel + 1) * half;
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            sum += weights[i] * (f(middle - nodes[i] * half) + f(middle + nodes[i] * half));
        }
    }
    return sum * half;
}

}  // namespace lucerna::truth
