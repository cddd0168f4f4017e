#include "spectral/dispersion_formula.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <stdexcept>

namespace lucerna::spectral {
namespace {

using Coefficients = std::span<const double>;

// C1 + the sum of term(a, b) over the pairs (a, b) of coefficients behind it.
template <typename Term>
double sum_over_pairs(Coefficients c, const Term& term) {
    double sum = c[0];
    for (std::size_t i = 1; i + 1 < c.size(); i += 2) sum += term(c[i], c[i + 1]);
    return sum;
}

double mixed_squared(Coefficients c, double lambda) {
    double sum = c[0];
    std::size_t i = 1;
    for (; i + 3 < c.size() && i < 9; i += 4) {
        sum += c[i] * std::pow(lambda, c[i + 1]) / (lambda * lambda - std::pow(c[i + 2], c[i + 3]));
    }
    for (; i + 1 < c.size(); i += 2) sum += c[i] * std::pow(lambda, c[i + 1]);
    return sum;
}

double herzberger(Coefficients c, double lambda) {
    const double square = lambda * lambda;
    const double h = 1.0 / (square - 0.028);
    const double terms[] = {1.0, h, h * h, square, square * square, square * square * square};
    double sum = 0.0;
    for (std::size_t i = 0; i < c.size(); ++i) sum += c[i] * terms[i];
    return sum;
}

double retro_squared(Coefficients c, double lambda) {
    const double square = lambda * lambda;
    const double ratio = c[0] + c[1] * square / (square - c[2]) + c[3] * square;
    return (1.0 + 2.0 * ratio) / (1.0 - ratio);
}

double exotic_squared(Coefficients c, double lambda) {
    const double offset = lambda - c[4];
    return c[0] + c[1] / (lambda * lambda - c[2]) + c[3] * offset / (offset * offset + c[5]);
}

double index(int number, Coefficients c, double lambda) {
    const double square = lambda * lambda;
    switch (number) {
        case 1:
            return std::sqrt(1.0 + sum_over_pairs(c, [&](double strength, double pole) {
                                 return strength * square / (square - pole * pole);
                             }));
        case 2:
            return std::sqrt(1.0 + sum_over_pairs(c, [&](double strength, double pole) {
                                 return strength * square / (square - pole);
                             }));
        case 3:
            return std::sqrt(sum_over_pairs(
                c, [&](double factor, double power) { return factor * std::pow(lambda, power); }));
        case 4:
            return std::sqrt(mixed_squared(c, lambda));
        case 5:
            return sum_over_pairs(
                c, [&](double factor, double power) { return factor * std::pow(lambda, power); });
        case 6:
            return 1.0 + sum_over_pairs(c, [&](double strength, double pole) {
                       return strength / (pole - 1.0 / square);
                   });
        case 7:
            return herzberger(c, lambda);
        case 8:
            return std::sqrt(retro_squared(c, lambda));
        case 9:
            return std::sqrt(exotic_squared(c, lambda));
        default:
            return std::numeric_limits<double>::quiet_NaN();
    }
}

struct Node {
    double wavelength_nm;
    double index;
};

// Appends the nodes between two neighbours that linear interpolation needs, and the second one.
void append_nodes(const DispersionFormula& formula, Node low, Node high, std::vector<Node>& nodes) {
    constexpr double tolerance = 2e-7;  // at the middle, where a parabola is worst
    constexpr double min_step_nm = 1e-3;
    const double middle_nm = 0.5 * (low.wavelength_nm + high.wavelength_nm);
    const Node middle{middle_nm, formula.index_at(middle_nm)};
    // written so that NaN is not close enough
    if (!(std::abs(middle.index - 0.5 * (low.index + high.index)) <= tolerance)) {
        if (high.wavelength_nm - low.wavelength_nm < min_step_nm) {
            throw std::domain_error(fmt::format("the formula has a pole at {:.6g} nm", middle_nm));
        }
        append_nodes(formula, low, middle, nodes);
        append_nodes(formula, middle, high, nodes);
    } else {
        nodes.push_back(high);
    }
}

}  // namespace

std::string DispersionFormula::problem() const {
    const std::size_t count = coefficients.size();
    const auto expect = [&](bool good, const char* expected) {
        return good ? std::string()
                    : fmt::format("formula {} has {} coefficients; expected {}", number, count,
                                  expected);
    };
    switch (number) {
        case 1:
        case 2:
        case 3:
        case 5:
        case 6:
            return expect(count % 2 == 1, "one and any number of pairs behind it");
        case 4:
            return expect(count % 2 == 1 && count != 3 && count != 7,
                          "1, 5 or 9, and any number of pairs behind these 9");
        case 7:
            return expect(count >= 1 && count <= 6, "1 to 6");
        case 8:
            return expect(count == 4, "4");
        case 9:
            return expect(count == 6, "6");
        default:
            return fmt::format("there is no formula {}; expected 1 to 9", number);
    }
}

double DispersionFormula::index_at(double wavelength_nm) const {
    const double n = index(number, coefficients, 1e-3 * wavelength_nm);
    return n > 0.0 && std::isfinite(n) ? n : std::numeric_limits<double>::quiet_NaN();
}

Spectrum DispersionFormula::tabulated(double from_nm, double to_nm) const {
    const auto node = [&](double wavelength_nm) {
        const Node result{wavelength_nm, index_at(wavelength_nm)};
        if (std::isnan(result.index)) {
            throw std::domain_error(
                fmt::format("the formula gives no positive index at {:.6g} nm", wavelength_nm));
        }
        return result;
    };
    std::vector<Node> nodes = {node(from_nm)};
    while (nodes.back().wavelength_nm < to_nm) {
        const double next_nm = std::min(std::floor(nodes.back().wavelength_nm) + 1.0, to_nm);
        append_nodes(*this, nodes.back(), node(next_nm), nodes);
    }
    std::vector<double> wavelengths_nm;
    std::vector<double> values;
    for (const Node& entry : nodes) {
        wavelengths_nm.push_back(entry.wavelength_nm);
        values.push_back(entry.index);
    }
    return {std::move(wavelengths_nm), std::move(values), Outside::hold};
}

}  // namespace lucerna::spectral
