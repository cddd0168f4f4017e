#include "optics/transport/path.h"

#include <bit>

namespace lucerna::optics {

Frame bsdf_frame(const Phase& phase, const SurfacePoint& point) {
    const auto& up = phase.stage.parts().objects[point.object].up;
    if (up) {
        const Vec3 across = up->cross(point.normal);
        const double length = across.norm();
        if (length > 1e-9) {
            const Vec3 x = across / length;
            return {x, point.normal.cross(x), point.normal};
        }
    }
    return Frame(point.normal);
}

namespace {

// An optional that is empty at first would be cleared as a whole, and it is large.
std::optional<Encounter> encounter_at(const Phase& phase, const Path& path, const Hit& hit) {
    const SceneParts& parts = phase.stage.parts();
    const Object& object = parts.objects[hit.point.object];
    const bool from_above = path.ray.direction.dot(hit.point.normal) < 0.0;
    const ObjectId here = path.media.acting(parts);
    const Frame frame = bsdf_frame(phase, hit.point);
    std::optional<Encounter> encounter(std::in_place, hit.point,
                                       phase.transmittance(here, hit.distance_m),
                                       from_above ? object.front : object.back, frame,
                                       frame.to_local(-path.ray.direction), here, here, path.media);
    if (object.interior) {
        encounter->consistent = from_above ? encounter->media_beyond.enter(hit.point.object)
                                           : encounter->media_beyond.leave(hit.point.object);
        const ObjectId beyond = encounter->media_beyond.acting(parts);
        (from_above ? encounter->medium_below : encounter->medium_above) = beyond;
        if (here == beyond) encounter->bsdf = pass_through;  // hidden in one of higher priority
    }
    return encounter;
}

}  // namespace

std::optional<Encounter> next_encounter(const Phase& phase, const Path& path) {
    if (phase.ray_log) phase.ray_log->push_back(path.ray);
    const SurfacePoint* start = path.start.object == no_object ? nullptr : &path.start;
    const auto hit = phase.stage.caster().intersect(path.ray, start);
    if (!hit) return std::nullopt;
    return encounter_at(phase, path, *hit);
}

SurfaceOptics optics_at(const Phase& phase, ObjectId medium_above, ObjectId medium_below,
                        bool hero_only, int hero) {
    return {.bsdfs = phase.stage.parts().bsdfs,
            .spectra = phase.spectra,
            .wavelengths = phase.wavelengths,
            .index_above = phase.index(medium_above),
            .index_below = phase.index(medium_below),
            .dispersive = phase.dispersive(medium_above) || phase.dispersive(medium_below),
            .hero_only = hero_only,
            .hero = hero,
            .polarisation = nullptr};
}

SurfaceOptics optics_at(const Phase& phase, const Encounter& encounter, Path& path) {
    SurfaceOptics optics =
        optics_at(phase, encounter.medium_above, encounter.medium_below, path.hero_only, path.hero);
    if (phase.stage.follows_polarisation()) {
        const Vec3& direction = path.ray.direction;
        if (phase.stage.is_specular(encounter.bsdf)) {  // other surfaces only depolarise
            path.polarisation.refer_to(axis_across_incidence(encounter.frame.normal, direction),
                                       direction);
        }
        optics.polarisation = &path.polarisation;
    }
    return optics;
}

void pass(Path& path, const Encounter& encounter) {
    path.ray.origin = encounter.point.position;
    path.start = encounter.point;
    path.media = encounter.media_beyond;
}

void follow(Path& path, const Encounter& encounter, const BsdfSample& sample) {
    path.ray = {encounter.point.position, encounter.frame.to_world(sample.wi).normalized()};
    path.start = encounter.point;
    if (sample.wi.z() * encounter.wo.z() < 0.0) path.media = encounter.media_beyond;
    path.weight *= sample.weight;
    path.hero_only = path.hero_only || sample.hero_only;
}

Fate roulette(Path& path, float factor, RandomStream& random) {
    if (!(factor > 0.0f)) return Fate::ended_by_roulette;
    if (factor < 1.0f - 1e-5f) {
        path.lossless_events = 0;
        if (random.uniform() >= static_cast<double>(factor)) return Fate::ended_by_roulette;
        path.weight /= factor;
        return Fate::goes_on;
    }
    ++path.lossless_events;
    if (path.lossless_events < first_lossless_roulette ||
        !std::has_single_bit(path.lossless_events)) {
        return Fate::goes_on;
    }
    if (path.lossless_events >= trapped_after_events) return Fate::trapped;
    if (random.uniform() >= 0.5) return Fate::ended_by_roulette;
    path.weight *= 2.0f;
    return Fate::goes_on;
}

}  // namespace lucerna::optics
