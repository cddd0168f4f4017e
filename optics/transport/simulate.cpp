// The page to read first. One phase (METHOD section 2):
//   1 forward trace, caustic          trace_photons(); another for indirect light if that is
//                                     gathered where it is seen
//   2 forward maps                    ForwardMaps
//   3 backward trace                  trace_backward(): emission, direct light, gathered light
//   4 secondary backward map          BackwardMap
//   5 forward trace, secondary        trace_and_deposit()
//   6 form the images and their error Readings, StopRule

#include "optics/transport/simulate.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <utility>

#include "core/parallel.h"
#include "optics/transport/accuracy.h"
#include "optics/transport/backward_trace.h"

namespace lucerna::optics {
namespace {

constexpr std::uint32_t rays_per_block = 256;
constexpr std::uint32_t blocks_per_chunk = 64;  // deposits of a chunk are held at once
constexpr std::uint32_t min_pilot_rays = 1 << 14, max_pilot_rays = 1 << 15;
// What the choice of the collection for images is made from.
constexpr std::uint32_t pilot_phases = 4;
constexpr std::size_t pilot_blocks = 64;
constexpr std::uint32_t min_forward_rays = 20000;
// Secondary forward rays per backward ray: their noise is averaged over all second scattering
// events that a kernel serves, so that few are enough (the same delta with 1 and with 1/4 in
// diffuse rooms).
constexpr std::uint64_t backward_per_secondary_ray = 16;
constexpr std::uint64_t backward_per_caustic_ray = 4;
// Expected photons in a kernel of the first phase: few where the kernel is hidden behind a
// scattering event, more where it is seen.
constexpr double photons_per_hidden_kernel = 16.0;
constexpr double photons_per_seen_kernel = 24.0;
// Where all indirect light is gathered at seen surfaces, it is mostly smooth: kernels are as wide
// as their bias allows. For each ray that a gather stands for, this many photons in the kernel, on
// average: then the maps have about the noise of the direct light, and gathering about its cost.
constexpr double photons_per_ray_of_wide_kernel = 32.0;

class Stopwatch {
public:
    double seconds() const {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    }

private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

class Simulation {
public:
    Simulation(const SceneParts& parts, const Settings& settings)
        : settings_(settings),
          stage_(parts, settings.polarisation),
          threads_(settings.threads > 0 ? settings.threads : hardware_threads()),
          planes_(stage_.parts(), stage_.caster(), stage_.caster().scene_radius_m() / 6.0),
          readings_(parts, settings),
          observed_(!readings_.blocks().empty()),
          collections_{Collection::of(settings.method, settings.planted_error),
                       Collection::of(settings.method, settings.planted_error)},
          caustic_rays_(settings.forward_rays.value_or(
              at_least_min(readings_.samples_per_phase() / backward_per_caustic_ray))),
          secondary_rays_(settings.forward_rays.value_or(
              at_least_min(readings_.samples_per_phase() / backward_per_secondary_ray))),
          total_(stage_.parts()),
          received_(2 * parts.receivers.size()) {
        for (const FluxReceiver& receiver : parts.receivers) {
            receiver_targets_.push_back(settings.target_of(receiver.name));
        }
        choose_radii();
        if (settings.method == Method::automatic) choose_collection_of_images();
    }

    void run_phase(std::uint32_t number) {
        const Phase phase(stage_, settings_.seed, number);
        ForwardTally tally(stage_.parts());
        trace_phase(phase, collections_, readings_.blocks(), tally);
        readings_.fold(phase, threads_);
        fold_tally(tally);
        ++phases_;
    }

    /// Largest ratio of the expanded uncertainty of a receiver to what is asked for.
    double worst_receiver() const {
        double worst = 0.0;
        for (std::size_t i = 0; i < stage_.parts().receivers.size(); ++i) {
            const Estimate& front = received_[2 * i];
            const Estimate& back = received_[2 * i + 1];
            const SensorTarget& target = receiver_targets_[i];
            // Relative to both sides together: hardly any light on one is no reason to go on.
            const double value = front.value() + back.value();
            for (const Estimate* side : {&front, &back}) {
                worst = std::max(
                    worst, excess(target, value, side->expanded_uncertainty(target_coverage)));
            }
        }
        return worst;
    }

    Result result() const {
        Result result;
        const SceneParts& parts = stage_.parts();
        result.images = readings_.images(parts);
        result.quantities = readings_.quantities(parts);
        for (std::size_t i = 0; i < parts.receivers.size(); ++i) {
            result.quantities.push_back(
                {parts.receivers[i].name + " (front)", "luminous flux", "lm", received_[2 * i]});
            result.quantities.push_back(
                {parts.receivers[i].name + " (back)", "luminous flux", "lm", received_[2 * i + 1]});
        }
        result.derived = readings_.derived(parts);
        result.flux_balance_lm = balance();
        result.rays = counts_;
        result.forward_map_bytes = forward_map_bytes_;
        result.backward_map_bytes = backward_map_bytes_;
        result.image_bytes = readings_.bytes();
        result.settings = settings_;
        result.settings.forward_rays = secondary_rays_;
        result.settings.threads = threads_;
        result.settings.polarisation = stage_.follows_polarisation();
        result.phases = phases_;
        add_warnings(result);
        return result;
    }

    const Readings& readings() const { return readings_; }
    const RayCounts& counts() const { return counts_; }
    const SceneParts& parts() const { return stage_.parts(); }

private:
    static std::uint32_t at_least_min(std::uint64_t rays) {
        return static_cast<std::uint32_t>(std::max<std::uint64_t>(min_forward_rays, rays));
    }
    static constexpr std::uint8_t mask(History history) {
        return static_cast<std::uint8_t>(history);
    }

    bool is_camera(const ObserverBins& bins) const {
        return std::holds_alternative<Camera>(stage_.parts().observers[bins.observer]);
    }

    // Whether light of a history is gathered from its forward map by anyone.
    bool gathers(const Collections& collections, History history) const {
        if (!observed_ || (history == History::caustic && !stage_.has_caustics())) return false;
        std::uint8_t wanted = collections.cameras.first_gather | collections.sensors.first_gather;
        if (planes_.count() > 0) wanted |= collections.sensors.sensor_gather;
        return wanted & mask(history);
    }

    // The flux balance and the receivers are taken from the secondary trace; without backward
    // photons from that of the indirect map, if there is one.
    bool traces_secondary(const Collections& collections) const {
        return collections.deposit() || !gathers(collections, History::indirect);
    }
    double balance_rays() const {
        return traces_secondary(collections_) ? secondary_rays_ : indirect_rays_;
    }

    // One phase: what the observers collect is added to the readings.
    void trace_phase(const Phase& phase, const Collections& collections,
                     const std::vector<BinBlock>& blocks, ForwardTally& tally) {
        const std::uint32_t radii_of = is_pilot(phase.number) ? 0 : phase.number;
        ForwardMaps maps;
        if (gathers(collections, History::caustic)) {
            maps.caustic_radii = caustic_radii_.at_phase(radii_of);
            ForwardTally unused(stage_.parts());
            maps.caustic =
                forward_map(phase, History::caustic, caustic_rays_, maps.caustic_radii, unused);
        }
        if (gathers(collections, History::indirect)) {
            maps.indirect_radii = indirect_radii_.at_phase(radii_of);
            ForwardTally indirect_tally(stage_.parts());
            maps.indirect = forward_map(phase, History::indirect, indirect_rays_,
                                        maps.indirect_radii, indirect_tally);
            if (!traces_secondary(collections)) tally = indirect_tally;
        }
        forward_map_bytes_ = std::max<std::uint64_t>(forward_map_bytes_,
                                                     maps.caustic.bytes() + maps.indirect.bytes());

        Stopwatch backward_watch;
        std::vector<std::vector<BackwardPhoton>> stored(blocks.size());
        std::vector<BackwardTally> backward_tallies(blocks.size());
        for_each_block(blocks.size(), threads_, [&](std::size_t i) {
            stored[i] = trace_backward(phase, collections, blocks[i], planes_, maps, readings_,
                                       backward_tallies[i]);
        });
        counts_.backward_s += backward_watch.seconds();
        counts_.backward_rays += readings_.samples_per_phase();
        for (const BackwardTally& block : backward_tallies) {
            counts_.backward_segments += block.segments;
            counts_.shadow_segments += block.shadow_segments;
        }

        if (!traces_secondary(collections)) return;
        Stopwatch map_watch;
        const Radii hidden_radii = hidden_radii_.at_phase(radii_of);
        BackwardMap backward_map(phase, hidden_radii, std::move(stored));
        counts_.maps_s += map_watch.seconds();
        counts_.backward_photons += backward_map.size();
        backward_map_bytes_ = std::max<std::uint64_t>(backward_map_bytes_, backward_map.bytes());
        Stopwatch watch;
        trace_and_deposit(phase, backward_map, tally);
        for_each_block(blocks.size(), threads_, [&](std::size_t i) {
            backward_map.read(i, secondary_rays_,
                              [&](std::uint32_t bin, const Lanes& radiance, const Lanes& bias) {
                                  readings_.add(phase, bin, radiance, bias);
                              });
        });
        counts_.secondary_s += watch.seconds();
    }

    // The photons of one history: caustics need no path beyond the first scattering event.
    ForwardMap forward_map(const Phase& phase, History history, std::uint32_t rays,
                           const Radii& radii, ForwardTally& tally) {
        const bool caustic = history == History::caustic;
        Stopwatch watch;
        std::vector<Photon> photons = trace_photons(
            phase, caustic ? RandomPurpose::caustic : RandomPurpose::indirect,
            caustic ? Reach::first_scattering : Reach::whole_path, mask(history), rays, tally);
        counts_.caustic_s += watch.seconds();
        counts_.caustic_rays += rays;
        counts_.forward_photons += photons.size();
        counts_.forward_segments += tally.segments;
        Stopwatch map_watch;
        ForwardMap map(stage_, radii, std::move(photons), rays);
        counts_.maps_s += map_watch.seconds();
        return map;
    }

    // Phases whose results are not used (DESIGN decision 1): numbered from the end.
    static constexpr std::uint32_t pilot_phase = std::numeric_limits<std::uint32_t>::max();
    static constexpr bool is_pilot(std::uint32_t number) {
        return number >= pilot_phase - pilot_phases;
    }

    // Radii and rays of the maps, from a few rays of a pilot phase.
    void choose_radii() {
        if (!observed_) return;
        const Phase phase(stage_, settings_.seed, pilot_phase);
        ForwardTally unused(stage_.parts());
        constexpr std::uint8_t caustic = mask(History::caustic);
        constexpr std::uint8_t indirect = mask(History::indirect);
        constexpr std::uint8_t all = mask(History::direct) | caustic | indirect;
        const std::uint32_t rays =
            std::clamp(std::max(caustic_rays_, secondary_rays_), min_pilot_rays, max_pilot_rays);
        const PilotPhotons photons{
            trace_photons(phase, RandomPurpose::pilot, Reach::whole_path, all, rays, unused), rays};
        const auto of = [&](History history) {
            PilotPhotons some{{}, rays};
            for (const Photon& photon : photons.photons) {
                if (photon.history == history) some.photons.push_back(photon);
            }
            return some;
        };
        caustic_radii_ = narrow_radii(stage_, planes_, of(History::caustic),
                                      photons_per_seen_kernel, caustic_rays_, true);
        hidden_radii_ = narrow_radii(stage_, planes_, photons, photons_per_hidden_kernel,
                                     secondary_rays_, false);
        const PilotPhotons of_indirect = of(History::indirect);
        indirect_radii_ = wide_radii(stage_, planes_, of_indirect);
        indirect_rays_ = settings_.forward_rays.value_or(
            std::clamp(rays_for(stage_, of_indirect, indirect_radii_, photons_per_wide_kernel()),
                       min_forward_rays, at_least_min(readings_.samples_per_phase())));
    }

    double photons_per_wide_kernel() const {
        std::uint32_t rays = 1;
        for (const ObserverBins& bins : readings_.observers()) {
            if (is_camera(bins)) {
                const Observer& observer = stage_.parts().observers[bins.observer];
                rays = std::max(rays, bins.samples_per_bin / gathers_of_bin(bins, observer));
            }
        }
        return photons_per_ray_of_wide_kernel * rays;
    }

    // Which of both ways to collect indirect light has less noise in a phase: the variance over
    // pilot phases of the same pixels, that of emission and direct light apart.
    void choose_collection_of_images() {
        std::vector<BinBlock> of_images;
        for (const BinBlock& block : readings_.blocks()) {
            if (is_camera(readings_.observers()[block.observer_bins])) of_images.push_back(block);
        }
        if (of_images.empty()) return;
        std::vector<BinBlock> some;
        for (std::size_t i = 0; i < std::min(pilot_blocks, of_images.size()); ++i) {
            some.push_back(
                of_images[i * of_images.size() / std::min(pilot_blocks, of_images.size())]);
        }
        const std::uint32_t indirect_rays = std::exchange(indirect_rays_, min_pilot_rays);
        const auto noise = [&](const Collection& collection) {
            const Collections both{collection, collection};
            for (std::uint32_t i = 1; i <= pilot_phases; ++i) {
                const Phase phase(stage_, settings_.seed, pilot_phase - i);
                ForwardTally unused(stage_.parts());
                trace_phase(phase, both, some, unused);
                readings_.fold(phase, threads_);
            }
            const double variance = readings_.image_variance();
            readings_ = Readings(stage_.parts(), settings_);
            return variance;
        };
        Collection combined = collections_.cameras;
        Collection merged = Collection::merged_where_seen();
        // Caustics are collected alike in both.
        combined.first_gather = 0;
        merged.first_gather = mask(History::indirect);
        // The noise of a map falls with its rays, that of single rays to a second scattering event
        // does not.
        const double of_merged = noise(merged) * indirect_rays_ / indirect_rays;
        if (of_merged < noise(combined)) collections_.cameras = Collection::merged_where_seen();
        indirect_rays_ = indirect_rays;
        counts_ = {};
    }

    // Photons of the given histories of all rays of a trace, in the order of the rays.
    std::vector<Photon> trace_photons(const Phase& phase, RandomPurpose purpose, Reach reach,
                                      std::uint8_t histories, std::uint32_t rays,
                                      ForwardTally& tally) {
        const std::uint32_t blocks = (rays + rays_per_block - 1) / rays_per_block;
        std::vector<std::vector<Photon>> photons(blocks);
        std::vector<ForwardTally> tallies(blocks, ForwardTally(stage_.parts()));
        for_each_block(blocks, threads_, [&](std::size_t block) {
            const auto first = static_cast<std::uint32_t>(block) * rays_per_block;
            for (std::uint32_t i = first; i < std::min(rays, first + rays_per_block); ++i) {
                trace_forward(phase, purpose, i, reach, &planes_, tallies[block],
                              [&](const Photon& photon) {
                                  if (histories & mask(photon.history)) {
                                      photons[block].push_back(photon);
                                  }
                              });
            }
        });
        std::vector<Photon> all;
        for (std::uint32_t block = 0; block < blocks; ++block) {
            all.insert(all.end(), photons[block].begin(), photons[block].end());
            tally += tallies[block];
        }
        return all;
    }

    void trace_and_deposit(const Phase& phase, BackwardMap& map, ForwardTally& tally) {
        // Without backward photons (path tracing) these rays serve receivers and flux balance.
        const std::uint32_t rays = secondary_rays_;
        const std::uint32_t blocks = (rays + rays_per_block - 1) / rays_per_block;
        for (std::uint32_t chunk = 0; chunk < blocks; chunk += blocks_per_chunk) {
            const std::uint32_t count = std::min(blocks_per_chunk, blocks - chunk);
            std::vector<BackwardMap::Deposits> deposits(count);
            std::vector<ForwardTally> tallies(count, ForwardTally(stage_.parts()));
            std::vector<std::uint64_t> hits(count);
            for_each_block(count, threads_, [&](std::size_t block) {
                const std::uint32_t first =
                    (chunk + static_cast<std::uint32_t>(block)) * rays_per_block;
                for (std::uint32_t i = first; i < std::min(rays, first + rays_per_block); ++i) {
                    trace_forward(phase, RandomPurpose::secondary, i, Reach::whole_path, nullptr,
                                  tallies[block], [&](const Photon& photon) {
                                      ++hits[block];
                                      map.find(photon, deposits[block]);
                                  });
                }
            });
            std::array<std::uint64_t, BackwardMap::parts> applied{};
            for_each_block(BackwardMap::parts, threads_,
                           [&](std::size_t part) { applied[part] = map.apply(part, deposits); });
            for (std::uint32_t block = 0; block < count; ++block) {
                tally += tallies[block];
                counts_.scattering_hits += hits[block];
            }
            for (const std::uint64_t deposited : applied) counts_.deposits += deposited;
        }
        counts_.secondary_rays += rays;
        counts_.forward_segments += tally.segments;
    }

    void fold_tally(const ForwardTally& tally) {
        const double rays = balance_rays();
        for (std::size_t i = 0; i < stage_.parts().receivers.size(); ++i) {
            const ObjectId object = stage_.parts().receivers[i].object;
            received_[2 * i].add(tally.received_front[object] / rays);
            received_[2 * i + 1].add(tally.received_back[object] / rays);
        }
        total_ += tally;
    }

    FluxBalance balance() const {
        const SceneParts& parts = stage_.parts();
        const double scale = 1.0 / (balance_rays() * std::max(1u, phases_));
        FluxBalance balance;
        balance.emitted = total_.emitted * scale;
        balance.escaped = total_.escaped * scale;
        balance.trapped = total_.trapped * scale;
        balance.inconsistent_medium = total_.inconsistent * scale;
        balance.numerical = total_.numerical * scale;
        balance.roulette_residue = total_.residue * scale;
        for (std::size_t i = 0; i < parts.objects.size(); ++i) {
            const Object& object = parts.objects[i];
            if (total_.absorbed_by_object[i] != 0.0) {
                balance.absorbed[object.material] += total_.absorbed_by_object[i] * scale;
            }
            if (object.interior && total_.absorbed_by_solid[i] != 0.0) {
                balance.absorbed["inside " + parts.media[*object.interior].name] +=
                    total_.absorbed_by_solid[i] * scale;
            }
        }
        return balance;
    }

    void add_warnings(Result& result) const {
        const FluxBalance& flux = result.flux_balance_lm;
        if (flux.inconsistent_medium > 1e-6 * flux.emitted) {
            result.warnings.emplace_back(
                "light was lost where transparent solids contradict each other: check for solids "
                "that share a face or are not closed");
        }
        if (flux.numerical > 0.0)
            result.warnings.emplace_back("light was lost to undefined numbers");
        if (settings_.method == Method::path && stage_.has_caustics()) {
            result.warnings.emplace_back(
                "path tracing does not see light of points and beams behind specular surfaces");
        }
    }

    Settings settings_;
    Stage stage_;
    int threads_;
    SensorPlanes planes_;
    Readings readings_;
    bool observed_;  // by any camera or sensor
    Collections collections_;
    std::uint32_t caustic_rays_, secondary_rays_;          // per phase
    std::uint32_t indirect_rays_ = 0;                      // per phase
    Radii caustic_radii_, indirect_radii_, hidden_radii_;  // of the first phase
    ForwardTally total_;                                   // over phases
    std::vector<Estimate> received_;                       // per receiver: front, back
    std::vector<SensorTarget> receiver_targets_;
    RayCounts counts_;
    std::uint64_t forward_map_bytes_ = 0, backward_map_bytes_ = 0;
    std::uint32_t phases_ = 0;
};

Settings with_default_target(Settings settings) {
    if (!settings.image_accuracy && !settings.sensor_accuracy && settings.sensor_targets.empty() &&
        !settings.time_limit_s && !settings.max_phases) {
        settings.image_accuracy = 0.02;
        settings.sensor_accuracy = 0.01;
    }
    return settings;
}

}  // namespace

double FluxBalance::closure() const {
    double rest = emitted - escaped - trapped - inconsistent_medium - numerical - roulette_residue;
    for (const auto& [name, flux] : absorbed) rest -= flux;
    return rest;
}

Result simulate(const SceneParts& parts, const Settings& asked,
                const std::function<void(const Progress&)>& on_progress,
                const std::atomic<bool>* interrupted) {
    const Stopwatch watch;
    const Settings settings = with_default_target(asked);
    Simulation simulation(parts, settings);
    const auto is_camera = [](const Observer& o) { return std::holds_alternative<Camera>(o); };
    const bool has_cameras = std::any_of(parts.observers.begin(), parts.observers.end(), is_camera);
    const bool has_sensors =
        !parts.receivers.empty() ||
        !std::all_of(parts.observers.begin(), parts.observers.end(), is_camera);
    StopRule rule(settings, has_cameras, has_sensors);

    std::string stopped_by;
    std::uint32_t phase = 0;
    while (stopped_by.empty()) {
        simulation.run_phase(phase++);
        const double elapsed_s = watch.seconds();
        stopped_by =
            rule.check(phase, simulation.readings(), simulation.worst_receiver(), elapsed_s);
        if (stopped_by.empty() && interrupted && interrupted->load()) stopped_by = "interruption";
        if (on_progress) {
            const RayCounts& counts = simulation.counts();
            const double rays = static_cast<double>(
                counts.backward_segments + counts.forward_segments + counts.shadow_segments);
            on_progress({.phase = phase,
                         .delta = phase > 1 ? simulation.readings().delta() : std::nan(""),
                         .delta_wanted = has_cameras ? settings.image_accuracy : std::nullopt,
                         .rays_per_s = rays / elapsed_s,
                         .elapsed_s = elapsed_s,
                         .left_s = rule.left_s(simulation.readings(), simulation.worst_receiver(),
                                               elapsed_s)});
        }
    }
    Result result = simulation.result();
    result.stopped_by = stopped_by;
    result.accuracy_reached = rule.accuracy_reached();
    result.wall_s = watch.seconds();
    return result;
}

}  // namespace lucerna::optics
