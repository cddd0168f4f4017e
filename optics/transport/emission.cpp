#include "optics/transport/emission.h"

#include <algorithm>

namespace lucerna::optics {

Emission::Emission(const Phase& phase, RandomPurpose purpose, const EmissionGuide& guide,
                   std::uint32_t rays)
    : Emission(phase, purpose, guide) {
    const DiscreteDistribution& lights = guide_ ? guide_->lights() : phase.stage.light_choice();
    // A systematic sample: ray i takes the light at (i + offset) / rays of the cumulative
    // distribution, so that the expected number of rays of a light is its probability times all.
    RandomStream random(phase.seed, phase.number, RandomPurpose::emission,
                        static_cast<std::uint32_t>(purpose));
    const double offset = random.uniform();
    double cumulative = 0.0;
    std::uint32_t first = 0;
    for (std::size_t light = 0; light < lights.size(); ++light) {
        cumulative += lights.probability(light);
        const bool last = light + 1 == lights.size();
        const double end = std::ceil(cumulative * rays - offset);
        const std::uint32_t next =
            last ? rays : static_cast<std::uint32_t>(std::clamp<double>(end, first, rays));
        shares_.push_back({first, next, random.bits()});
        first = next;
    }
}

Departure Emission::depart(std::uint32_t index, RandomStream& random) const {
    const auto depart = [&](std::size_t light, const std::array<double, 4>& u) {
        return guide_ ? guide_->depart(light, u) : Departure{light, u, 1.0};
    };
    if (shares_.empty()) {
        const DiscreteDistribution& lights =
            guide_ ? guide_->lights() : phase_.stage.light_choice();
        const std::size_t light = lights.sample(random.uniform());
        std::array<double, 4> u{};
        for (double& number : u) number = random.uniform();
        return depart(light, u);
    }
    const auto share =
        std::upper_bound(shares_.begin(), shares_.end(), index,
                         [](std::uint32_t ray, const Share& own) { return ray < own.end; });
    StratifiedStream stratified(random,
                                {share->set, index - share->first, share->end - share->first});
    const auto [u1, u2] = stratified.pair();
    const auto [u3, u4] = stratified.pair();
    random = stratified;
    return depart(static_cast<std::size_t>(share - shares_.begin()), {u1, u2, u3, u4});
}

}  // namespace lucerna::optics
