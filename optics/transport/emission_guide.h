// Where rays should leave the lights, as learned from rays whose use is known.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "optics/transport/square_density.h"

namespace lucerna::optics {

/// The first choices of a ray: its light, and the uniform numbers that light emits it by.
struct Departure {
    std::size_t light = 0;
    std::array<double, 4> u = {};
    /// Density of a choice in proportion to flux over that of the one made: a factor of the flux.
    double weight = 1.0;
};

/// A ray that was chosen in proportion to flux, and how much it was of use: the square of what it
/// brings.
struct RayOfUse {
    Departure departure;
    double use = 0.0;
};

/// A density over lights and the numbers they emit by, higher where rays are of use. No ray is left
/// out, so that what is estimated stays unbiased.
///
/// The variance of a sum over rays is least if they are chosen with a density in proportion to the
/// root of the mean square of what they bring (Kahn and Marshall, J. Oper. Res. Soc. Am. 1, 1953,
/// 263). Each light has a table of that root over one pair of its four numbers: over that pair, and
/// in cells of that size, which have the least variance when one half of the rays judges what the
/// other half has taught. A light that nothing can be learned about keeps an even density.
class EmissionGuide {
public:
    EmissionGuide() = default;  ///< teaches nothing
    /// @param flux  of the lights, in any unit.
    EmissionGuide(std::span<const double> flux, std::span<const RayOfUse> rays);

    /// Whether no ray was of use.
    bool empty() const { return tables_.empty(); }

    const DiscreteDistribution& lights() const { return lights_; }
    /// The departure from a light that uniform numbers lead to, for lights chosen by lights().
    Departure depart(std::size_t light, std::array<double, 4> u) const;

    /// A density over one pair of the numbers.
    class Table {
    public:
        Table() = default;  ///< even
        Table(int pair, std::size_t side, std::span<const RayOfUse> rays);
        /// Moves the pair to where the density is; returns 1 over the density there.
        double warp(std::array<double, 4>& u) const {
            return density_.warp(u[first_], u[first_ + 1]);
        }
        double density(const std::array<double, 4>& u) const {
            return density_.density(u[first_], u[first_ + 1]);
        }

    private:
        std::size_t first_ = 0;  // of the pair
        SquareDensity density_;
    };

private:
    DiscreteDistribution lights_;
    std::vector<double> light_weights_;
    std::vector<Table> tables_;  // of each light
};

}  // namespace lucerna::optics
