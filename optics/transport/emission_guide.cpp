#include "optics/transport/emission_guide.h"

#include <algorithm>
#include <cmath>

namespace lucerna::optics {
namespace {

// Share of the rays that is chosen as if nothing had been learned: what a few thousand rays did not
// find is then still found by rays of at most 5 times the usual weight.
constexpr double share_of_unguided = 0.2;
constexpr std::size_t most_side = 64;
// Lights with fewer rays of use keep an even density.
constexpr std::size_t least_rays_of_use = 16;

// Expected square of what a ray brings if rays are chosen by the table, in the mean over the rays.
double mean_square(const EmissionGuide::Table& table, std::span<const RayOfUse> rays) {
    double sum = 0.0;
    for (const RayOfUse& ray : rays) {
        if (ray.use > 0.0) sum += ray.use / table.density(ray.departure.u);
    }
    return rays.empty() ? 0.0 : sum / static_cast<double>(rays.size());
}

struct Choice {
    EmissionGuide::Table table;
    double mean_square;
};

Choice choose(std::span<const RayOfUse> rays) {
    Choice best{{}, mean_square({}, rays)};
    const auto of_use =
        std::count_if(rays.begin(), rays.end(), [](const RayOfUse& ray) { return ray.use > 0.0; });
    if (static_cast<std::size_t>(of_use) < least_rays_of_use) return best;
    const auto one = rays.first(rays.size() / 2);
    const auto other = rays.subspan(rays.size() / 2);
    for (const int pair : {0, 1}) {
        for (std::size_t side = 2; side <= most_side; side *= 2) {
            const double judged = 0.5 * (mean_square({pair, side, one}, other) +
                                         mean_square({pair, side, other}, one));
            if (judged < best.mean_square) best = {{pair, side, rays}, judged};
        }
    }
    return best;
}

}  // namespace

EmissionGuide::Table::Table(int pair, std::size_t side, std::span<const RayOfUse> rays)
    : first_(2 * static_cast<std::size_t>(pair)) {
    std::vector<double> use(side * side);
    for (const RayOfUse& ray : rays) {
        const auto& u = ray.departure.u;
        use[SquareDensity::cell(side, u[first_], u[first_ + 1])] += ray.use;
    }
    std::vector<double> roots = with_neighbours(side, use);
    for (double& root : roots) root = std::sqrt(root);
    density_ = SquareDensity(side, roots, share_of_unguided);
}

EmissionGuide::EmissionGuide(std::span<const double> flux, std::span<const RayOfUse> rays) {
    if (std::none_of(rays.begin(), rays.end(), [](const RayOfUse& ray) { return ray.use > 0.0; })) {
        return;
    }
    std::vector<std::vector<RayOfUse>> of_lights(flux.size());
    for (const RayOfUse& ray : rays) of_lights[ray.departure.light].push_back(ray);
    const DiscreteDistribution by_flux(flux);
    std::vector<double> wanted;
    double total = 0.0;
    for (std::size_t light = 0; light < flux.size(); ++light) {
        const Choice choice = choose(of_lights[light]);
        tables_.push_back(choice.table);
        wanted.push_back(by_flux.probability(light) * std::sqrt(choice.mean_square));
        total += wanted.back();
    }
    std::vector<double> probabilities;
    for (std::size_t light = 0; light < flux.size(); ++light) {
        probabilities.push_back(share_of_unguided * by_flux.probability(light) +
                                (1.0 - share_of_unguided) * wanted[light] / total);
    }
    lights_ = DiscreteDistribution(probabilities);
    for (std::size_t light = 0; light < flux.size(); ++light) {
        const double probability = lights_.probability(light);
        light_weights_.push_back(probability > 0.0 ? by_flux.probability(light) / probability
                                                   : 0.0);
    }
}

Departure EmissionGuide::depart(std::size_t light, std::array<double, 4> u) const {
    const double weight = light_weights_[light] * tables_[light].warp(u);
    return {light, u, weight};
}

}  // namespace lucerna::optics
