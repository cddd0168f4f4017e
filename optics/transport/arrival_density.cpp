#include "optics/transport/arrival_density.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"

namespace lucerna::optics {
namespace {

constexpr double share_even = 0.3;
constexpr std::size_t photons_per_point = 256;  // the nearest ones
constexpr std::size_t least_photons = 32;
constexpr std::size_t most_side = 32;
constexpr std::size_t most_densities = 4096;  // of an observer: neighbours share them

struct Arrival {
    Vec3 position;
    double u1, u2;  // that sample_cosine_hemisphere() makes its direction of
    double flux;
    bool above;
    std::uint32_t caustic_of;  // light, or no_light
};

SquareDensity density_of(std::size_t side, std::span<const Arrival> arrivals) {
    if (side == 1) return {};
    std::vector<double> flux(side * side);
    for (const Arrival& a : arrivals) flux[SquareDensity::cell(side, a.u1, a.u2)] += a.flux;
    return {side, with_neighbours(side, flux), share_even};
}

// Logarithm of the likelihood of the arrivals, weighted with their flux.
double likelihood(const SquareDensity& density, std::span<const Arrival> arrivals) {
    double sum = 0.0;
    for (const Arrival& a : arrivals) sum += a.flux * std::log(density.density(a.u1, a.u2));
    return sum;
}

SquareDensity learned(std::span<const Arrival> arrivals) {
    const auto one = arrivals.first(arrivals.size() / 2);
    const auto other = arrivals.subspan(arrivals.size() / 2);
    std::size_t best_side = 1;
    double best = 0.0;
    for (std::size_t side = 2; side <= most_side; side *= 2) {
        const double judged =
            likelihood(density_of(side, one), other) + likelihood(density_of(side, other), one);
        if (judged > best) {
            best = judged;
            best_side = side;
        }
    }
    return density_of(best_side, arrivals);
}

// From the photons nearest to a point, of all that arrive on its patch.
// @param looks_for  lights, see BinRays.
SquareDensity learned_around(const Vec3& point, bool above, std::span<const Arrival> on_patch,
                             const std::vector<bool>& looks_for) {
    std::vector<Arrival> near;
    for (const Arrival& arrival : on_patch) {
        const bool wanted =
            arrival.caustic_of == no_light || (!looks_for.empty() && looks_for[arrival.caustic_of]);
        if (wanted && arrival.above == above) near.push_back(arrival);
    }
    if (near.size() < least_photons) return {};
    if (near.size() > photons_per_point) {
        std::nth_element(near.begin(), near.begin() + photons_per_point, near.end(),
                         [&](const Arrival& a, const Arrival& b) {
                             return (a.position - point).squaredNorm() <
                                    (b.position - point).squaredNorm();
                         });
        near.resize(photons_per_point);
    }
    return learned(near);
}

std::vector<std::vector<Arrival>> arrivals_by_patch(const Phase& phase, const TraceContext& context,
                                                    const PilotPhotons& pilot) {
    std::vector<std::vector<Arrival>> arrivals(context.stage.patch_count() +
                                               context.planes.count());
    for (const Photon& photon : pilot.photons) {
        if (photon.history == History::direct) continue;
        const Frame frame = photon.point.object == no_object ? Frame(photon.point.normal)
                                                             : bsdf_frame(phase, photon.point);
        const Vec3 wi = frame.to_local(-photon.direction);
        const Vec2 u = numbers_of_disk_sample({wi.x(), wi.y()});
        arrivals[kernel_patch(context.stage, photon.point)].push_back(
            {photon.point.position, u.x(), u.y(),
             luminous_flux(phase.wavelengths.luminance, photon), wi.z() > 0.0,
             photon.history == History::caustic ? photon.light : no_light});
    }
    return arrivals;
}

}  // namespace

void scatter_to_arrivals(const Phase& phase, const TraceContext& context, const SeenPoints& seen,
                         const PilotPhotons& pilot, BackwardRays& rays) {
    const auto arrivals = arrivals_by_patch(phase, context, pilot);
    const auto& observers = context.readings.observers();
    for (std::size_t i = 0; i < observers.size(); ++i) {
        const ObserverBins& bins = observers[i];
        const Observer& observer = context.stage.parts().observers[bins.observer];
        if (std::holds_alternative<IlluminancePoints>(observer)) {
            const std::size_t bins_per_density = (bins.count + most_densities - 1) / most_densities;
            std::vector<ArrivalDensity> densities((bins.count + bins_per_density - 1) /
                                                  bins_per_density);
            for_each_block(densities.size(), context.threads, [&](std::size_t k) {
                const auto& point = context.planes.point(bins.observer, k * bins_per_density);
                const std::uint32_t patch = context.stage.patch_count() + point.plane;
                densities[k] = {
                    patch, true,
                    learned_around(point.position, true, arrivals[patch], rays.looks_for(i))};
            });
            rays.guide(i, std::move(densities), bins_per_density);
        } else if (std::holds_alternative<LuminanceMeter>(observer)) {
            // The middle one of the points that it sees: nearly all lie on one surface.
            std::vector<const BackwardPhoton*> own;
            for (const BackwardPhoton& vertex : seen.vertices) {
                if (vertex.point.object != no_object && vertex.bin == bins.first_bin) {
                    own.push_back(&vertex);
                }
            }
            if (own.empty()) continue;
            const BackwardPhoton& vertex = *own[own.size() / 2];
            const std::uint32_t patch = kernel_patch(context.stage, vertex.point);
            const bool above = vertex.wo.z() > 0.0;
            rays.guide(i,
                       {{patch, above,
                         learned_around(vertex.point.position, above, arrivals[patch],
                                        rays.looks_for(i))}},
                       1);
        }
    }
}

}  // namespace lucerna::optics
