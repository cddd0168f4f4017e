#include "spectral/integral.h"

#include <algorithm>
#include <cmath>

namespace lucerna::spectral {
namespace {

// The range cut at every node of both spectra.
std::vector<double> pieces(const Spectrum& a, const Spectrum& b, double from_nm, double to_nm) {
    std::vector<double> nodes = {from_nm, to_nm};
    for (const Spectrum* spectrum : {&a, &b}) {
        const std::vector<double>& own = spectrum->wavelengths_nm();
        nodes.insert(nodes.end(), std::upper_bound(own.begin(), own.end(), from_nm),
                     std::lower_bound(own.begin(), own.end(), to_nm));
    }
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    return nodes;
}

}  // namespace

double integral_of_product(const Spectrum& a, const Spectrum& b, double from_nm, double to_nm) {
    if (!(from_nm < to_nm)) return 0.0;
    const std::vector<double> nodes = pieces(a, b, from_nm, to_nm);
    // Gauss-Legendre with two points is exact for the quadratic product on each piece, and never
    // asks for a value at a node, where a spectrum may jump to zero.
    const double offset = 0.5 / std::sqrt(3.0);
    double sum = 0.0;
    for (std::size_t i = 1; i < nodes.size(); ++i) {
        const double width_nm = nodes[i] - nodes[i - 1];
        const double middle_nm = nodes[i - 1] + 0.5 * width_nm;
        for (const double point_nm :
             {middle_nm - offset * width_nm, middle_nm + offset * width_nm}) {
            sum += 0.5 * width_nm * a.at(point_nm) * b.at(point_nm);
        }
    }
    return sum;
}

}  // namespace lucerna::spectral
