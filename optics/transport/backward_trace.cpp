#include "optics/transport/backward_trace.h"

#include <algorithm>

#include "optics/transport/bin_gathers.h"

namespace lucerna::optics {
namespace {

// A branch that carries less of its path goes on by choosing one event at random.
constexpr double least_importance_to_branch = 0.02;

/// One backward ray on its way.
class BackwardRay {
public:
    BackwardRay(const Phase& phase, const Collections& collections, const ObserverBins& bins,
                const SensorPlanes& planes, const ForwardMaps& maps, PhaseReadings& readings,
                BackwardTally& tally, std::vector<BackwardPhoton>& stored)
        : phase_(phase),
          collection_(is_camera(phase.stage.parts(), bins) ? collections.cameras
                                                           : collections.sensors),
          planes_(planes),
          readings_(readings),
          tally_(tally),
          gathers_(phase, bins, maps, readings),
          stored_(stored) {
        const Observer& observer = phase.stage.parts().observers[bins.observer];
        if (const auto* camera = std::get_if<Camera>(&observer)) {
            camera_rays_.emplace(*camera);
            media_of_observer_ = phase.stage.media_at(camera->from);
        } else if (const auto* meter = std::get_if<LuminanceMeter>(&observer)) {
            media_of_observer_ = phase.stage.media_at(meter->position);
        }
    }

    std::vector<CutKernel> take_cut_kernels() { return gathers_.take_cut_kernels(); }

    /// All rays of a bin.
    void trace(const ObserverBins& bins, std::size_t bin, const BinRays& rays, RaySums* sums) {
        bin_ = static_cast<std::uint32_t>(bins.first_bin + bin);
        const Observer& observer = phase_.stage.parts().observers[bins.observer];
        if (std::holds_alternative<IlluminancePoints>(observer)) {
            media_of_observer_ = phase_.stage.media_at(planes_.point(bins.observer, bin).position);
        }
        const std::uint32_t set =
            RandomStream(phase_.seed, phase_.number, RandomPurpose::strata, bin_).bits();
        rays_ = rays;
        if (rays.count == 0) return;
        if (rays.looks_for) tally_.lights_found.resize(rays.looks_for->size());
        gathers_.start(bin_, rays);
        for (std::uint32_t ray = 0; ray < rays.count; ++ray) {
            StratifiedStream random(
                {phase_.seed, phase_.number, RandomPurpose::backward, rays.first_path + ray},
                {set, ray, rays.count});
            gathers_.next_ray(ray);
            const double before = readings_.luminance(bin_);
            const std::uint64_t segments = tally_.segments + tally_.shadow_segments;
            trace(bins, bin, ray, random);
            if (sums) {
                const auto luminance =
                    static_cast<float>(rays.count * (readings_.luminance(bin_) - before));
                sums->rays += 1.0f;
                sums->luminance += luminance;
                sums->square += luminance * luminance;
                sums->kernel_bias += static_cast<float>(rays.count * gathers_.kernel_bias());
                sums->kernel_bias_variance += static_cast<float>(
                    square(static_cast<double>(rays.count)) * gathers_.kernel_bias_variance());
                sums->barriers += static_cast<float>(gathers_.cut_by_barriers());
                sums->caustic_summed += gathers_.caustic_summed();
                sums->indirect_summed += gathers_.indirect_summed();
                sums->segments +=
                    static_cast<float>(tally_.segments + tally_.shadow_segments - segments);
            }
        }
    }

private:
    // A backward ray, or one of its branches, and how it has come this far.
    struct Way {
        Path path;
        double importance = 1.0;  // share of the ray's weight that its branches left to it
        int scatterings = 0;
        int counted = 0;  // of them, those that do not just pass the path on: v of Collection
        bool lit = true;  // direct light was sampled at the last scattering event
        bool specular_since = false;  // the last scattering event
        bool straight = true;         // no event yet: all rays of the bin come this way
        Vec3 scattered_from = Vec3::Zero();
        double scattered_pdf = 0.0;
    };

    void trace(const ObserverBins& bins, std::size_t bin, std::uint32_t sample,
               StratifiedStream& random) {
        way_.scatterings = way_.counted = 0;
        way_.specular_since = false;
        way_.straight = true;
        way_.path.start.object = no_object;
        way_.path.media = media_of_observer_;
        way_.path.weight = Lanes::Constant(1.0f / static_cast<float>(rays_.count));
        way_.path.hero_only = false;
        // Even over the rays of a bin, so that their mean has hardly any noise of wavelengths.
        way_.path.hero =
            phase_.stage.disperses() ? choose_common_hero(phase_, random.pair()[0]) : 0;
        way_.path.lossless_events = 0;
        way_.path.polarisation.depolarise();
        way_.importance = 1.0;
        if (!leave_observer(bins, bin, sample, random)) return;
        while (true) {
            while (next_event(random)) {
            }
            if (branches_.empty()) return;
            way_ = branches_.back();
            branches_.pop_back();
        }
    }

    // Starts the ray; false if nothing remains to be traced.
    bool leave_observer(const ObserverBins& bins, std::size_t bin, std::uint32_t sample,
                        StratifiedStream& random) {
        const Observer& observer = phase_.stage.parts().observers[bins.observer];
        const auto [u1, u2] = random.pair();
        if (const auto* camera = std::get_if<Camera>(&observer)) {
            const auto width = static_cast<std::size_t>(camera->width);
            way_.path.ray = camera_rays_->through(static_cast<double>(bin % width) + u1,
                                                  static_cast<double>(bin / width) + u2);
        } else if (const auto* meter = std::get_if<LuminanceMeter>(&observer)) {
            const Frame frame(meter->direction);
            way_.path.ray = {
                meter->position,
                frame.to_world(sample_cone(std::cos(meter->acceptance_half_angle_rad), u1, u2))};
        } else {
            const auto& points = std::get<IlluminancePoints>(observer);
            // All samples of a point gather the same photons: the first does it for all.
            if (sample == 0) {
                gather_at_sensor(points, planes_.point(bins.observer, bin));
            }
            return leave_sensor(points, planes_.point(bins.observer, bin), u1, u2, random);
        }
        return true;
    }

    // An illuminance point is the first scattering event of its rays: a virtual white diffuser
    // whose luminance is L = E / pi.
    template <typename Use>
    void at_sensor(const IlluminancePoints& points, const SensorPlanes::Point& sensor,
                   const Use& use) {
        const SurfacePoint point{sensor.position, points.normal, no_object, sensor.plane,
                                 sensor.plane};
        const Frame frame(points.normal);
        const Vec3 wo = Vec3::UnitZ();
        const Bsdf& diffuser = phase_.stage.parts().bsdfs[phase_.stage.white_diffuser()];
        const SurfaceOptics optics = optics_at(phase_, no_object, no_object, false, 0);
        GatherPoint at{point, frame, wo, diffuser, optics, sensor.clearance_m, sensor.index};
        at.but_of = rays_.looks_for;
        use(at);
    }

    void gather_at_sensor(const IlluminancePoints& points, const SensorPlanes::Point& sensor) {
        at_sensor(points, sensor, [&](const GatherPoint& at) {
            gathers_.at_sensor(at, collection_.sensor_gather);
        });
    }

    // Weights of direct light keep to the density of the cosine: any weights that add up to one
    // for a direction leave the sum unbiased.
    void scatter_to_arrivals(double& u1, double& u2) {
        way_.path.weight *= static_cast<float>(rays_.arrivals->density.warp(u1, u2));
    }

    bool leave_sensor(const IlluminancePoints& points, const SensorPlanes::Point& sensor, double u1,
                      double u2, StratifiedStream& random) {
        const Vec3& position = sensor.position;
        way_.path.weight *= static_cast<float>(pi);
        LightSamples samples = LightSamples::weighed;
        at_sensor(points, sensor, [&](const GatherPoint& at) {
            samples = samples_of_lights(at);
            readings_.add(
                phase_, bin_,
                way_.path.weight * direct_light(phase_, at, nullptr, way_.path.media,
                                                way_.path.media, samples, {}, ShadowRays::of_all,
                                                random, tally_.shadow_segments));
        });
        if (samples == LightSamples::alone) return false;
        if (rays_.arrivals) scatter_to_arrivals(u1, u2);
        const Vec3 wi = sample_cosine_hemisphere(u1, u2);
        way_.path.ray = {position, Frame(points.normal).to_world(wi)};
        ++way_.counted;
        scattered_at(position, wi.z() / pi, true);
        return true;
    }

    // Follows the path to the next surface and through its event; false when the path has ended.
    bool next_event(StratifiedStream& random) {
        const Stage& stage = phase_.stage;
        const auto encounter = next_encounter(phase_, way_.path);
        ++tally_.segments;
        if (!encounter) return false;
        way_.path.weight *= encounter->transmittance;
        add_emission(*encounter);
        if (!encounter->consistent) return false;
        if (encounter->bsdf == pass_through) {
            pass(way_.path, *encounter);
            return true;
        }
        const bool collected = way_.counted > 0 && !collection_.whole_path;
        if (collected && (way_.counted > 1 || !goes_on_from_first())) return false;

        const Bsdf& bsdf = stage.parts().bsdfs[encounter->bsdf];
        const SurfaceOptics optics = optics_at(phase_, *encounter, way_.path);
        const bool above = encounter->wo.z() > 0.0;
        const Glossy passes_on = passes_on_at(*encounter);
        const bool lit = !collected || collection_.second_direct;
        const bool branches = way_.counted == 0 && way_.importance >= least_importance_to_branch;
        const Event event{*encounter, bsdf, optics, passes_on, lit, collected};
        EventSplit split;
        if (stage.scatters(encounter->bsdf)) {
            GatherPoint at{encounter->point, encounter->frame, encounter->wo, bsdf, optics};
            at.from_above = !(above ? passes_on.reflection : passes_on.transmission);
            at.from_below = !(above ? passes_on.transmission : passes_on.reflection);
            const std::uint8_t here =
                at.from_above || at.from_below ? ~0 : ~mask(History::indirect);
            if (way_.counted == 0) {
                if (way_.scatterings == 0) at.but_of = rays_.looks_for;
                gathers_.where_seen(at, collection_.first_gather & here, way_.path, way_.straight);
                store(*encounter, collection_.first_deposit & here);
            } else if (collected) {
                store(*encounter, collection_.second_deposit & here);
            }
            if (branches) {
                split = event_split(bsdf, optics, encounter->wo, Transport::radiance);
            }
            if (lit && add_direct_light(event, at, split, random) == LightSamples::alone) {
                return false;
            }
        }
        if (branches && way_.scatterings == 0 && std::holds_alternative<SmoothDielectric>(bsdf)) {
            branch(*encounter, bsdf, optics);
            return true;
        }
        if (!split.has_both()) return scatter(event, 0.0, 1.0, random);
        // Both are followed: few rays would else find a lamp behind a sheet that reflects more than
        // it transmits, or in a floor that mirrors a little.
        const Way before = way_;
        if (scatter(event, split.first, 1.0, random)) branches_.push_back(way_);
        way_ = before;
        return scatter(event, 0.0, split.first, random);
    }

    // Where the ray has come to, and what is done there.
    struct Event {
        const Encounter& encounter;
        const Bsdf& bsdf;
        const SurfaceOptics& optics;
        Glossy passes_on;
        bool lit, collected;
    };

    // What does not count at the event: see Collection.
    Glossy passes_on_at(const Encounter& encounter) const {
        if (way_.counted == 0 && collection_.reaches_second_event()) return {};
        const Glossy& glossy = phase_.stage.glossy(encounter.bsdf, encounter.wo.z() > 0.0);
        // A stored event accepts photons from both sides.
        if (way_.counted > 0 && !(glossy.reflection && glossy.transmission)) return {};
        return glossy;
    }

    // Goes on from an event by one of the lobes from `first` to `last`, of 0 to 1; false when the
    // path has ended.
    bool scatter(const Event& event, double first, double last, StratifiedStream& random) {
        const auto& [encounter, bsdf, optics, glossy, lit, collected] = event;
        const double share = last - first;
        const double u_lobe = std::min(first + share * random.uniform(), std::nextafter(last, 0.0));
        auto [u1, u2] = random.pair();
        if (way_.scatterings == 0 && rays_.arrivals && std::holds_alternative<Diffuse>(bsdf) &&
            rays_.arrivals->patch == kernel_patch(phase_.stage, encounter.point) &&
            rays_.arrivals->above == (encounter.wo.z() > 0.0)) {
            scatter_to_arrivals(u1, u2);
        }
        const auto sampled =
            sample(bsdf, optics, encounter.wo, u_lobe, u1, u2, Transport::radiance);
        if (!sampled) return false;
        const bool transmitted = sampled->wi.z() * encounter.wo.z() < 0.0;
        const bool passes_on = transmitted ? glossy.transmission : glossy.reflection;
        // Beyond the second event a ray is followed for the emission that it might find.
        if (collected && !passes_on && !sampled->specular && !lit) return false;
        const bool turned_hero = sampled->hero_only && !way_.path.hero_only;
        const Lanes factors = sampled->weight * encounter.transmittance;
        follow(way_.path, encounter, *sampled);
        if (sampled->specular) {
            way_.specular_since = true;
            way_.straight = false;
        } else {
            if (passes_on) {
                way_.straight = false;
            } else {
                ++way_.counted;
            }
            scattered_at(encounter.point.position, sampled->pdf_solid_angle / share, lit);
        }
        float factor = live_max(way_.path, factors);
        if (turned_hero) factor /= spectral::lane_count;
        if (transmitted) {
            // Radiance changes with n^2 and back again; that is no reason to end or to keep a path.
            const int hero = way_.path.hero;
            const float ratio = encounter.wo.z() > 0.0
                                    ? optics.index_below[hero] / optics.index_above[hero]
                                    : optics.index_above[hero] / optics.index_below[hero];
            factor *= ratio * ratio;
        }
        way_.path.weight *= static_cast<float>(share);
        way_.importance *= share;
        // The rarer kind of two is worth its ray.
        if (share < 0.5) return factor > 0.0f;
        return roulette(way_.path, factor, random) == Fate::goes_on;
    }

    // What is seen in and through a smooth boundary is followed both ways, unless it matters
    // little: a lamp seen by reflection of a few percent would else be a rare bright dot.
    void branch(const Encounter& encounter, const Bsdf& bsdf, const SurfaceOptics& optics) {
        Path path = way_.path;
        const auto one =
            sample(bsdf, optics, encounter.wo, one_event, 0.0, 0.0, Transport::radiance);
        if (one->probability < 1.0) {
            SurfaceOptics of_other = optics;
            if (of_other.polarisation) of_other.polarisation = &path.polarisation;
            const auto other =
                sample(bsdf, of_other, encounter.wo, other_event, 0.0, 0.0, Transport::radiance);
            follow(path, encounter, *other);
            path.weight *= static_cast<float>(other->probability);
            branches_.push_back({.path = path,
                                 .importance = way_.importance * other->probability,
                                 .straight = false});
        }
        follow(way_.path, encounter, *one);
        way_.path.weight *= static_cast<float>(one->probability);
        way_.importance *= one->probability;
    }

    void scattered_at(const Vec3& position, double pdf, bool lit) {
        ++way_.scatterings;
        way_.specular_since = false;
        way_.lit = lit;
        way_.scattered_from = position;
        way_.scattered_pdf = pdf;
    }

    void add_emission(const Encounter& encounter) {
        const std::uint32_t light = phase_.stage.light_of(encounter.point.object);
        if (light == no_light) return;
        double weight = 1.0;
        if (way_.scatterings > 0 && way_.specular_since) {
            const bool found =
                way_.scatterings == 1 && rays_.looks_for && (*rays_.looks_for)[light];
            if (!found && !collection_.emission_behind_specular) return;  // the maps' part
            if (found) ++tally_.lights_found[light];
        } else if (way_.scatterings > 0) {
            if (!way_.lit) return;  // the maps' part, too
            weight = emission_weight(phase_, light, way_.scattered_from, encounter.point,
                                     way_.scattered_pdf);
        }
        const Lanes radiance =
            emitted_radiance(phase_, light, encounter.point, -way_.path.ray.direction);
        readings_.add(phase_, bin_, way_.path.weight * radiance * static_cast<float>(weight));
    }

    // Whether rays that the first event scatters are of use, but for emission seen straight.
    bool goes_on_from_first() const { return collection_.second_deposit || rays_.looks_for; }

    // Where a path need not go on but for emission that a scattered ray might find.
    LightSamples samples_of_lights(const GatherPoint& at) const {
        const bool ends = !collection_.whole_path && (way_.counted > 0 || !goes_on_from_first());
        return ends && lights_suffice(phase_.stage, at.bsdf, at.point.position)
                   ? LightSamples::alone
                   : LightSamples::weighed;
    }

    LightSamples add_direct_light(const Event& event, const GatherPoint& at,
                                  const EventSplit& split, StratifiedStream& random) {
        const Encounter& encounter = event.encounter;
        const bool above = encounter.wo.z() > 0.0;
        const LightSamples samples = samples_of_lights(at);
        const ShadowRays shadow_rays =
            way_.counted > 0 && !collection_.whole_path ? ShadowRays::of_one : ShadowRays::of_all;
        readings_.add(phase_, bin_,
                      way_.path.weight *
                          direct_light(phase_, at, &encounter.point,
                                       above ? way_.path.media : encounter.media_beyond,
                                       above ? encounter.media_beyond : way_.path.media, samples,
                                       split, shadow_rays, random, tally_.shadow_segments));
        return samples;
    }

    void store(const Encounter& encounter, std::uint8_t accepts) {
        if (!accepts) return;
        stored_.push_back({.point = encounter.point,
                           .wo = encounter.wo,
                           .throughput = way_.path.weight,
                           .bsdf = encounter.bsdf,
                           .medium_above = encounter.medium_above,
                           .medium_below = encounter.medium_below,
                           .bin = bin_,
                           .accepts = accepts,
                           .hero_only = way_.path.hero_only,
                           .hero = static_cast<std::uint8_t>(way_.path.hero)});
    }

    const Phase& phase_;
    const Collection& collection_;
    const SensorPlanes& planes_;
    PhaseReadings& readings_;
    BackwardTally& tally_;
    BinGathers gathers_;
    std::vector<BackwardPhoton>& stored_;

    Way way_;
    std::uint32_t bin_ = 0;
    BinRays rays_{};                         // of the bin
    std::optional<CameraRays> camera_rays_;  // of a camera
    MediumStack media_of_observer_;          // where the rays of the present bin start
    std::vector<Way> branches_;  // before the first scattering event, still to be followed
};

}  // namespace

std::vector<BackwardPhoton> trace_backward(const Phase& phase, const Collections& collections,
                                           const ObserverBins& bins, const BackwardRays& rays,
                                           const BinBlock& block, const SensorPlanes& planes,
                                           const ForwardMaps& maps, PhaseReadings& readings,
                                           BackwardTally& tally, std::vector<RaySums>* sums) {
    std::vector<BackwardPhoton> stored;
    BackwardRay ray(phase, collections, bins, planes, maps, readings, tally, stored);
    for (std::size_t bin = block.first; bin < block.last; ++bin) {
        ray.trace(bins, bin, rays.of(block.observer_bins, bin),
                  sums ? &(*sums)[bins.first_bin + bin] : nullptr);
    }
    tally.cut_kernels = ray.take_cut_kernels();
    return stored;
}

}  // namespace lucerna::optics
