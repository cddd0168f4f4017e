#include "optics/transport/forward_trace.h"

#include <algorithm>
#include <array>

namespace lucerna::optics {
namespace {

// Adds lists that are as long as the scene has objects.
void add(std::vector<double>& sum, const std::vector<double>& part) {
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += part[i];
}

Path emitted_path(const Phase& phase, const Departure& departure, bool common_hero,
                  RandomStream& random) {
    const Stage& stage = phase.stage;
    const Light& light = stage.parts().lights[departure.light];
    const auto& [u1, u2, u3, u4] = departure.u;
    const EmittedRay emitted = emit(light.source, u1, u2, u3, u4);
    const double scale =
        emitted.weight * departure.weight / stage.light_choice().probability(departure.light);
    const double u_hero = random.uniform();
    return {.ray = emitted.ray,
            .start = emitted.surface,
            .media = stage.media_at(emitted.ray.origin + stage.nudge_m() * emitted.ray.direction),
            .weight = phase.spectra[light.flux_w_per_nm] * static_cast<float>(scale),
            .hero_only = false,
            .hero = common_hero ? choose_common_hero(phase, u_hero) : choose_hero(u_hero),
            .lossless_events = 0};
}

// A guided ray that carries more than this times its natural flux, that of rays chosen in
// proportion to flux, goes both ways at a smooth boundary. Most carry less, and one that rare
// reflections led to where the others are light would make most of the noise there, and be found by
// few phases.
constexpr double heavy = 0.05;

// A forward ray between two surfaces.
struct Flight {
    Path path;
    History history;
    double share;        // of the natural flux
    bool split = false;  // one of the directions of a split, which does not split again
};

// Shifts a number from [0, 1) around that interval.
double shifted(double u, double by) {
    return u + by < 1.0 ? u + by : u + by - 1.0;
}

class ForwardTrace {
public:
    ForwardTrace(const Phase& phase, bool common_heroes, Reach reach, const SensorPlanes* planes,
                 std::uint32_t light, ForwardTally& tally,
                 const std::function<void(const Photon&)>& arrive)
        : phase_(phase),
          common_heroes_(common_heroes),
          reach_(reach),
          planes_(planes),
          light_(light),
          tally_(tally),
          arrive_(arrive) {}

    void trace(Flight flight, RandomStream& random) {
        while (true) {
            flux_lm_ = phase_.luminous(flight.path.weight);
            while (next_event(flight, random)) {
            }
            if (branches_.empty()) return;
            flight = branches_.back();
            branches_.pop_back();
        }
    }

private:
    // To the next surface and away from it; false where the flight ends.
    bool next_event(Flight& flight, RandomStream& random) {
        Path& path = flight.path;
        const Stage& stage = phase_.stage;
        const SceneParts& parts = stage.parts();
        const auto on_common_lane = [&] { return path.hero_only && common_heroes_; };

        const auto encounter = next_encounter(phase_, path);
        ++tally_.segments;
        if (planes_ && flight.history != History::direct) {
            const double length_m =
                encounter ? (encounter->point.position - path.ray.origin).norm() : infinity;
            const ObjectId medium = path.media.acting(parts);
            planes_->crossings(path.ray, length_m, [&](const SurfacePoint& point) {
                const double way_m = (point.position - path.ray.origin).norm();
                const Lanes flux = path.weight * phase_.transmittance(medium, way_m);
                arrive_({point, path.ray.direction, phase_.tristimulus(flux), flight.history,
                         on_common_lane(), light_});
            });
        }
        if (!encounter) {
            tally_.escaped += flux_lm_;
            return false;
        }
        const ObjectId solid = path.media.acting(parts);
        float factor = 1.0f;
        if (phase_.absorbs(solid)) {
            path.weight *= encounter->transmittance;
            const double left_lm = phase_.luminous(path.weight);
            tally_.absorbed_by_solid[solid] += flux_lm_ - left_lm;
            flux_lm_ = left_lm;
            factor = live_max(path, encounter->transmittance);
        }
        const ObjectId object = encounter->point.object;
        (encounter->wo.z() > 0.0 ? tally_.received_front : tally_.received_back)[object] +=
            flux_lm_;
        if (!encounter->consistent) {
            tally_.inconsistent += flux_lm_;
            return false;
        }
        if (encounter->bsdf == pass_through) {
            pass(path, *encounter);
            return true;
        }
        if (stage.scatters(encounter->bsdf)) {
            arrive_({encounter->point, path.ray.direction, path.weight, flight.history,
                     on_common_lane(), light_});
            // A surface with both kinds of lobes lets the path go on by the specular one.
        }
        const Bsdf& bsdf = parts.bsdfs[encounter->bsdf];
        const bool smooth = std::holds_alternative<SmoothDielectric>(bsdf);
        const auto event = [&](Path& arriving, double u_lobe, double u1, double u2) {
            return sample(bsdf, optics_at(phase_, *encounter, arriving), encounter->wo, u_lobe, u1,
                          u2, Transport::flux);
        };
        if (reach_ == Reach::whole_path_split && !flight.split && stage.scatters(encounter->bsdf)) {
            split(flight, *encounter, factor, event, random);
            return false;
        }
        std::optional<BsdfSample> sampled;
        double kept = 1.0;  // share of the flux, the rest goes the other way
        if (smooth && reach_ == Reach::first_scattering && flight.share > heavy) {
            Path other = path;
            sampled = event(path, one_event, 0.0, 0.0);
            kept = sampled->probability;
            if (kept < 1.0) {
                const auto otherwise = event(other, other_event, 0.0, 0.0);
                follow(other, *encounter, *otherwise);
                other.weight *= static_cast<float>(otherwise->probability);
                tally_.residue -= phase_.luminous(other.weight);
                branches_.push_back(
                    {other, History::caustic, flight.share * otherwise->probability});
            }
        } else {
            const double u_lobe = random.uniform();
            const double u1 = random.uniform();
            const double u2 = random.uniform();
            sampled = event(path, u_lobe, u1, u2);
        }
        return goes_on(flight, *encounter, factor, kept, sampled, random);
    }

    // Away from an encounter in several directions, which fill those of the lobes evenly, as
    // shifted points of Hammersley do: each is an unbiased sample by itself.
    void split(const Flight& flight, const Encounter& encounter, float factor, const auto& event,
               RandomStream& random) {
        constexpr std::size_t n = directions_of_split;
        constexpr std::array<double, n> bits_reversed{0.0, 0.5, 0.25, 0.75};
        const double lobe = random.uniform();
        const double first = random.uniform();
        const double second = random.uniform();
        const double part_lm = flux_lm_ / n;
        branches_.reserve(n);
        for (std::size_t i = 0; i < n; ++i) {
            Flight part = flight;
            part.path.weight *= 1.0f / n;
            part.split = true;
            if (!part.path.hero_only) {  // parts behind dispersive boundaries differ in it
                constexpr int apart = spectral::lane_count / static_cast<int>(n);
                part.path.hero =
                    (part.path.hero + apart * static_cast<int>(i)) % spectral::lane_count;
            }
            flux_lm_ = part_lm;
            const double u = static_cast<double>(i) / n;
            const auto sampled = event(part.path, shifted(lobe, u), shifted(first, u),
                                       shifted(second, bits_reversed[i]));
            if (goes_on(part, encounter, factor, 1.0, sampled, random)) branches_.push_back(part);
        }
    }

    // Away from an encounter in a sampled direction; false where the flight ends.
    // @param factor  of the segment before, see live_max()
    // @param kept    share of the flux that the sample stands for
    bool goes_on(Flight& flight, const Encounter& encounter, float factor, double kept,
                 const std::optional<BsdfSample>& sampled, RandomStream& random) {
        Path& path = flight.path;
        const ObjectId object = encounter.point.object;
        if (!sampled || (reach_ == Reach::first_scattering && !sampled->specular)) {
            tally_.absorbed_by_object[object] += flux_lm_;
            return false;
        }
        const bool turned_hero = sampled->hero_only && !path.hero_only;
        follow(path, encounter, *sampled);
        factor *= turned_hero ? sampled->weight[path.hero] / spectral::lane_count
                              : live_max(path, sampled->weight);
        path.weight *= static_cast<float>(kept);
        flight.share *= kept;
        const double scattered_lm = phase_.luminous(path.weight);
        if (!std::isfinite(scattered_lm)) {
            tally_.numerical += flux_lm_;
            return false;
        }
        // A smooth boundary takes nothing: the change is the luck of choosing lane and lobe.
        const bool lossless =
            std::holds_alternative<SmoothDielectric>(phase_.stage.parts().bsdfs[encounter.bsdf]);
        (lossless ? tally_.residue : tally_.absorbed_by_object[object]) += flux_lm_ - scattered_lm;
        flux_lm_ = scattered_lm;
        if (!sampled->specular) {
            flight.history = History::indirect;
        } else if (flight.history == History::direct) {
            flight.history = History::caustic;
        }

        const Fate fate = roulette(path, factor, random);
        if (fate == Fate::trapped) {
            tally_.trapped += flux_lm_;
            return false;
        }
        if (fate == Fate::ended_by_roulette) {
            tally_.residue += flux_lm_;
            return false;
        }
        const double scaled_lm = phase_.luminous(path.weight);
        tally_.residue += flux_lm_ - scaled_lm;
        flux_lm_ = scaled_lm;
        return true;
    }

    const Phase& phase_;
    bool common_heroes_;
    Reach reach_;
    const SensorPlanes* planes_;
    std::uint32_t light_;
    ForwardTally& tally_;
    const std::function<void(const Photon&)>& arrive_;
    double flux_lm_ = 0.0;          // of the flight
    std::vector<Flight> branches_;  // still to be followed
};

}  // namespace

void ForwardTally::operator+=(const ForwardTally& other) {
    emitted += other.emitted;
    escaped += other.escaped;
    trapped += other.trapped;
    inconsistent += other.inconsistent;
    numerical += other.numerical;
    residue += other.residue;
    add(absorbed_by_object, other.absorbed_by_object);
    add(absorbed_by_solid, other.absorbed_by_solid);
    add(received_front, other.received_front);
    add(received_back, other.received_back);
    segments += other.segments;
}

void trace_forward(const Phase& phase, const Emission& emission, std::uint32_t index, Reach reach,
                   const SensorPlanes* planes, ForwardTally& tally,
                   const std::function<void(const Photon&)>& arrive) {
    RandomStream random = emission.random(index);
    const Departure departure = emission.depart(index, random);
    const Path path = emitted_path(phase, departure, emission.common_heroes(), random);
    tally.emitted += phase.luminous(path.weight);
    ForwardTrace(phase, emission.common_heroes(), reach, planes,
                 static_cast<std::uint32_t>(departure.light), tally, arrive)
        .trace({path, History::direct, emission.guided() ? departure.weight : 0.0}, random);
}

}  // namespace lucerna::optics
