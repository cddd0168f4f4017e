#include "optics/transport/benchmark.h"

#include <algorithm>
#include <functional>

#include "core/parallel.h"
#include "core/stopwatch.h"
#include "optics/transport/plan.h"

namespace lucerna::optics {
namespace {

constexpr std::size_t rays_per_task = 512;
constexpr std::size_t gathers_per_task = 256;
constexpr std::size_t tasks_per_chunk = 256;  // deposits of a chunk are held at once

using Work = std::function<void()>;

double seconds_of(const Work& work) {
    const Stopwatch watch;
    work();
    return watch.seconds();
}

// The choice costs pilot phases and has no say in what is measured here.
Settings without_choice_of_collection(Settings settings) {
    if (settings.method == Method::automatic) settings.method = Method::combined;
    return settings;
}

class Bench {
public:
    Bench(const SceneParts& parts, const Settings& settings, const RateEffort& effort)
        : effort_(effort),
          stage_(parts, settings.polarisation),
          planes_(stage_.parts(), stage_.caster(), stage_.caster().scene_radius_m() / 6.0),
          phase_(stage_, settings.seed, 0),
          readings_(parts, settings),
          values_(readings_.new_phase()),
          context_{stage_, planes_, readings_, Scheduler::ordered,
                   *std::max_element(effort.threads.begin(), effort.threads.end())},
          plan_(make_plan(context_, without_choice_of_collection(settings))) {}

    TraceRates forward_trace() {
        const std::uint32_t rays = effort_.paths / whole_paths_per_path(plan_.indirect_reach);
        const Emission emission(phase_, RandomPurpose::indirect, EmissionGuide{}, rays);
        return trace_rates(
            [&](int threads) { arrivals(emission, plan_.indirect_reach, rays, threads, false); });
    }

    TraceRates backward_trace() {
        const std::vector<BinBlock> blocks = some_blocks();
        return trace_rates([&](int threads) { trace(blocks, to_second_event, threads); });
    }

    BackwardMapRates backward_map() {
        BackwardMapRates rates;
        const auto vertices = trace(plan_.rays.blocks(), to_second_event, context_.threads);
        for (const auto& block : vertices) rates.build.items += block.size();
        if (rates.build.items == 0) return rates;
        const auto photons = arrivals(Emission(phase_, RandomPurpose::secondary), Reach::whole_path,
                                      plan_.secondary_rays, context_.threads, true);
        for (const auto& task : photons) rates.find.items += task.size();

        BackwardMap map;
        std::vector<double> build_s(effort_.threads.size(), infinity);
        std::vector<double> find_s = build_s, apply_s = build_s;
        for (int repetition = 0; repetition < effort_.repetitions; ++repetition) {
            for (std::size_t i = 0; i < effort_.threads.size(); ++i) {
                auto copy = vertices;  // the map takes them over
                const Stopwatch watch;
                map = BackwardMap(phase_, plan_.hidden_radii, std::move(copy), effort_.threads[i]);
                build_s[i] = std::min(build_s[i], watch.seconds());
                const DepositWork work = deposit(map, photons, effort_.threads[i]);
                find_s[i] = std::min(find_s[i], work.find_s);
                apply_s[i] = std::min(apply_s[i], work.apply_s);
                rates.deposit.items = work.deposits;
            }
        }
        set_per_s(rates.build, build_s);
        set_per_s(rates.find, find_s);
        set_per_s(rates.deposit, apply_s);
        return rates;
    }

    ForwardMapRates forward_map(History history) {
        ForwardMapRates rates;
        if (!plan_.observed) return rates;
        const bool caustic = history == History::caustic;
        const Radii& radii = caustic ? plan_.caustic_radii : plan_.indirect_radii;
        const std::uint32_t rays = caustic ? plan_.caustic_rays : plan_.indirect_rays;
        ForwardTally unused(stage_.parts());
        const auto photons = trace_photon_lists(
            phase_, context_,
            caustic ? Emission(phase_, RandomPurpose::caustic, plan_.caustic_guide, rays)
                    : Emission(phase_, RandomPurpose::indirect, EmissionGuide{}, rays),
            caustic ? Reach::first_scattering : plan_.indirect_reach, mask(history), rays, unused);
        for (const auto& list : photons) rates.build.items += list.size();
        if (rates.build.items == 0) return rates;

        ForwardMap map;
        set_per_s(rates.build, best_of_all_threads([&](int threads) {
                      map = ForwardMap(stage_, radii, photons, rays, threads);
                  }));
        std::vector<BackwardPhoton> seen;
        for (const auto& block : trace(some_blocks(), to_first_event, context_.threads)) {
            seen.insert(seen.end(), block.begin(), block.end());
        }
        rates.gather.items = seen.size();
        set_per_s(rates.gather,
                  best_of_all_threads([&](int threads) { gather(map, radii, seen, threads); }));
        return rates;
    }

private:
    static constexpr std::uint8_t all_histories =
        mask(History::direct) | mask(History::caustic) | mask(History::indirect);
    static constexpr Collection to_first_event{.first_deposit = all_histories};
    static constexpr Collection to_second_event{.second_deposit = all_histories};

    static void set_per_s(Rate& rate, const std::vector<double>& seconds) {
        rate.per_s.clear();
        if (rate.items == 0) return;
        for (const double s : seconds) rate.per_s.push_back(static_cast<double>(rate.items) / s);
    }

    // Least seconds of each work; the works take turns.
    std::vector<double> best_seconds(const std::vector<Work>& works) const {
        std::vector<double> best(works.size(), infinity);
        for (int repetition = 0; repetition < effort_.repetitions; ++repetition) {
            for (std::size_t i = 0; i < works.size(); ++i) {
                best[i] = std::min(best[i], seconds_of(works[i]));
            }
        }
        return best;
    }

    std::vector<double> best_of_all_threads(const std::function<void(int)>& work) const {
        std::vector<Work> works;
        for (const int threads : effort_.threads) works.push_back([&, threads] { work(threads); });
        return best_seconds(works);
    }

    // `trace(threads)` is run once to take down its rays; then traces and bare casts take turns.
    TraceRates trace_rates(const std::function<void(int)>& trace) {
        std::vector<Ray> rays;
        phase_.ray_log = &rays;
        trace(1);
        phase_.ray_log = nullptr;
        const auto cast = [&](int threads) {
            const std::size_t tasks = (rays.size() + rays_per_task - 1) / rays_per_task;
            for_each_block(tasks, threads, [&](std::size_t task) {
                const std::size_t first = task * rays_per_task;
                stage_.caster().raw_intersect(
                    std::span(rays).subspan(first, std::min(rays_per_task, rays.size() - first)));
            });
        };
        std::vector<Work> works;
        for (const int threads : effort_.threads) {
            works.push_back([&, threads] { trace(threads); });
            works.push_back([&, threads] { cast(threads); });
        }
        const std::vector<double> best_s = best_seconds(works);
        TraceRates rates;
        rates.traced.items = rates.bare.items = rays.size();
        std::vector<double> traced_s, bare_s;
        for (std::size_t i = 0; i < best_s.size(); i += 2) {
            traced_s.push_back(best_s[i]);
            bare_s.push_back(best_s[i + 1]);
        }
        set_per_s(rates.traced, traced_s);
        set_per_s(rates.bare, bare_s);
        return rates;
    }

    // Blocks from all over the observers, with about the number of paths asked for.
    std::vector<BinBlock> some_blocks() const {
        const std::vector<BinBlock>& all = plan_.rays.blocks();
        std::vector<BinBlock> some;
        if (all.empty()) return some;
        const double share = std::min(
            1.0, static_cast<double>(effort_.paths) / static_cast<double>(plan_.rays.per_phase()));
        const auto count = std::max<std::size_t>(
            1, static_cast<std::size_t>(share * static_cast<double>(all.size())));
        for (std::size_t i = 0; i < count; ++i)
            some.push_back(all[spread_out(i, count, all.size())]);
        return some;
    }

    std::vector<std::vector<BackwardPhoton>> trace(const std::vector<BinBlock>& blocks,
                                                   const Collection& collection, int threads) {
        std::vector<std::vector<BackwardPhoton>> stored(blocks.size());
        const ForwardMaps no_maps;
        for_each_block(blocks.size(), threads, [&](std::size_t i) {
            BackwardTally tally;
            stored[i] = trace_backward(phase_, {collection, collection},
                                       readings_.observers()[blocks[i].observer_bins], plan_.rays,
                                       blocks[i], planes_, no_maps, values_, tally);
        });
        return stored;
    }

    // Traces forward rays; what arrives at scattering surfaces, by tasks, if it is to be kept.
    std::vector<std::vector<Photon>> arrivals(const Emission& emission, Reach reach,
                                              std::uint32_t rays, int threads, bool kept) const {
        std::vector<std::vector<Photon>> photons((rays + forward_rays_per_block - 1) /
                                                 forward_rays_per_block);
        for_each_block(photons.size(), threads, [&](std::size_t task) {
            ForwardTally tally(stage_.parts());
            const auto first = static_cast<std::uint32_t>(task) * forward_rays_per_block;
            for (std::uint32_t i = first; i < std::min(rays, first + forward_rays_per_block); ++i) {
                trace_forward(phase_, emission, i, reach, nullptr, tally,
                              [&](const Photon& photon) {
                                  if (kept) photons[task].push_back(photon);
                              });
            }
        });
        return photons;
    }

    struct DepositWork {
        double find_s = 0.0, apply_s = 0.0;
        std::uint64_t deposits = 0;
    };

    static DepositWork deposit(BackwardMap& map, const std::vector<std::vector<Photon>>& arrivals,
                               int threads) {
        DepositWork work;
        for (std::size_t first = 0; first < arrivals.size(); first += tasks_per_chunk) {
            const std::size_t count = std::min(tasks_per_chunk, arrivals.size() - first);
            std::vector<BackwardMap::Deposits> deposits(count);
            work.find_s += seconds_of([&] {
                for_each_block(count, threads, [&](std::size_t i) {
                    for (const Photon& photon : arrivals[first + i]) map.find(photon, deposits[i]);
                });
            });
            std::array<std::uint64_t, BackwardMap::parts> applied{};
            work.apply_s += seconds_of([&] {
                for_each_block(BackwardMap::parts, threads, [&](std::size_t part) {
                    applied[part] = map.apply(part, deposits);
                });
            });
            for (const std::uint64_t deposited : applied) work.deposits += deposited;
        }
        return work;
    }

    void gather(const ForwardMap& map, const Radii& radii, const std::vector<BackwardPhoton>& seen,
                int threads) const {
        std::vector<Lanes> sums((seen.size() + gathers_per_task - 1) / gathers_per_task);
        for_each_block(sums.size(), threads, [&](std::size_t task) {
            Lanes sum = Lanes::Zero();
            const std::size_t first = task * gathers_per_task;
            for (std::size_t i = first; i < std::min(seen.size(), first + gathers_per_task); ++i) {
                const BackwardPhoton& vertex = seen[i];
                const Frame frame = bsdf_frame(phase_, vertex.point);
                const SurfaceOptics optics =
                    optics_at(phase_, vertex.medium_above, vertex.medium_below, vertex.hero_only,
                              vertex.hero);
                const Bsdf& bsdf = stage_.parts().bsdfs[vertex.bsdf];
                sum += map.gather(phase_, radii, {vertex.point, frame, vertex.wo, bsdf, optics})
                           .radiance;
            }
            sums[task] = sum;  // kept, so that no compiler leaves the work out
        });
    }

    const RateEffort& effort_;
    Stage stage_;
    SensorPlanes planes_;
    Phase phase_;
    Readings readings_;
    PhaseReadings values_;  // written, never read
    TraceContext context_;
    Plan plan_;
};

}  // namespace

Rates measure_rates(const SceneParts& parts, const Settings& settings, const RateEffort& effort) {
    Bench bench(parts, settings, effort);
    Rates rates;
    rates.threads = effort.threads;
    rates.forward = bench.forward_trace();
    rates.backward = bench.backward_trace();
    rates.backward_map = bench.backward_map();
    rates.caustic_map = bench.forward_map(History::caustic);
    rates.indirect_map = bench.forward_map(History::indirect);
    return rates;
}

}  // namespace lucerna::optics
