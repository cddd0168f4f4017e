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
    : pair_(pair), side_(side) {
    std::vector<double> use(side * side);
    for (const RayOfUse& ray : rays) {
        const double* u = ray.departure.u.data() + 2 * pair;
        use[cell(u[0]) * side + cell(u[1])] += ray.use;
    }
    // With the neighbours: what is of use does not end where the few rays that were traced do.
    const auto near = [&](std::size_t row, std::size_t column) {
        double sum = 0.0;
        double count = 0.0;
        for (std::size_t i = row - std::min<std::size_t>(row, 1); i <= std::min(row + 1, side - 1);
             ++i) {
            for (std::size_t j = column - std::min<std::size_t>(column, 1);
                 j <= std::min(column + 1, side - 1); ++j) {
                const double share = (i == row ? 2.0 : 1.0) * (j == column ? 2.0 : 1.0);
                sum += share * use[i * side + j];
                count += share;
            }
        }
        return sum / count;
    };
    std::vector<double> roots;
    double total = 0.0;
    for (std::size_t row = 0; row < side; ++row) {
        for (std::size_t column = 0; column < side; ++column) {
            roots.push_back(std::sqrt(near(row, column)));
            total += roots.back();
        }
    }
    const auto cells = static_cast<double>(side * side);
    std::vector<double> of_rows;
    for (std::size_t row = 0; row < side; ++row) {
        const auto first = roots.begin() + static_cast<std::ptrdiff_t>(row * side);
        double sum = 0.0;
        for (auto root = first; root != first + static_cast<std::ptrdiff_t>(side); ++root) {
            const double learned = total > 0.0 ? *root / total : 1.0 / cells;
            *root = share_of_unguided / cells + (1.0 - share_of_unguided) * learned;
            sum += *root;
        }
        of_rows.push_back(sum);
        columns_.emplace_back(std::span<const double>(&*first, side));
    }
    rows_ = DiscreteDistribution(of_rows);
}

std::size_t EmissionGuide::Table::cell(double u) const {
    return std::min(static_cast<std::size_t>(u * static_cast<double>(side_)), side_ - 1);
}

double EmissionGuide::Table::warp(std::array<double, 4>& u) const {
    if (side_ == 1) return 1.0;
    double* const own = u.data() + 2 * pair_;
    const auto side = static_cast<double>(side_);
    double rest = 0.0;
    const std::size_t row = rows_.sample(own[0], &rest);
    own[0] = (static_cast<double>(row) + rest) / side;
    const std::size_t column = columns_[row].sample(own[1], &rest);
    own[1] = (static_cast<double>(column) + rest) / side;
    return 1.0 / (side * side * rows_.probability(row) * columns_[row].probability(column));
}

double EmissionGuide::Table::density(const std::array<double, 4>& u) const {
    if (side_ == 1) return 1.0;
    const double* const own = u.data() + 2 * pair_;
    const auto side = static_cast<double>(side_);
    const std::size_t row = cell(own[0]);
    return side * side * rows_.probability(row) * columns_[row].probability(cell(own[1]));
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
