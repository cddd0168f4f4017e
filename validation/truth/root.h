// Roots of monotonic functions.
#pragma once

namespace lucerna::truth {

/// Where f changes sign between a and b, by bisection, to the last digits of (b - a).
template <typename Function>
double root(const Function& f, double a, double b) {
    const bool positive_at_a = f(a) > 0.0;
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (a + b);
        ((f(middle) > 0.0) == positive_at_a ? a : b) = middle;
    }
    return 0.5 * (a + b);
}

}  // namespace lucerna::truth
