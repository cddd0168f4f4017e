#include "optics/transport/forward_map.h"

#include <algorithm>
#include <array>
#include <bit>
#include <numbers>

#include "optics/transport/path.h"

namespace lucerna::optics {
namespace {

constexpr std::uint32_t no_lattice = ~0u;

// Points of lattices of a map: some 20 MB.
constexpr double most_lattice_points = 1 << 17;
// Where a gather stands for more than this share of a cell of the lattice, the lattice would need
// nearly as many.
constexpr double most_seen_per_cell = 0.5;
// Bias of what is interpolated over that of the kernels: along each axis, between points at a
// distance h, the second moment is h^2 / 6 in the mean over all places, that of the disc is r^2
// / 4. Where half of the disc is cut off, the bias is O(r), and what is linear stays.
constexpr float bias_of_interpolation(float cut_off) {
    constexpr auto of_whole =
        static_cast<float>(2.0 / 3.0 * spacing_per_radius * spacing_per_radius);
    return 1.0f + of_whole * std::clamp(1.0f - 2.0f * cut_off, 0.0f, 1.0f);
}

// Elsewhere the distance along the surface may be longer than the straight one.
bool is_straight(const Stage& stage, const SurfacePoint& p) {
    return p.object == no_object || !unrolls(stage.parts().objects[p.object].shape, p.patch);
}

bool is_on_plane_patch(const Stage& stage, const SurfacePoint& p) {
    return p.object != no_object && stage.patch_is_plane(stage.patch_index(p));
}

// Areas of a kernel, or of what barriers leave of it.
KernelAreas areas_left(const Stage& stage, const GatherPoint& at, double radius_m) {
    KernelAreas areas = at.region ? KernelAreas{at.region->area_m2(radius_m),
                                                at.region->area_m2(inner_radius_factor * radius_m)}
                                  : kernel_areas(stage, at.point, radius_m);
    if (areas.full == pi * radius_m * radius_m && is_straight(stage, at.point)) {
        areas = {areas.full, areas.full, true};
    }
    return areas;
}

// A kernel, as narrow as it is where a part of it is cut off.
struct OwnKernel {
    double radius_m;
    KernelAreas areas;
};
OwnKernel own_kernel(const Stage& stage, const GatherPoint& at, double radius_m,
                     double share_of_cut) {
    const KernelAreas areas = areas_left(stage, at, radius_m);
    const double own_m = cut_radius_m(areas, radius_m, share_of_cut);
    return {own_m, own_m < radius_m ? areas_left(stage, at, own_m) : areas};
}

// Light that arrives in a kernel, before or after the surface scatters it.
struct KernelLight : KernelSums {
    PerAxis slope = zero_per_axis, step = zero_per_axis;
    std::uint32_t photons = 0;

    // @param way  from the centre of the kernel, in radii.
    void add_moments(const Lanes& flux, const Vec3& way) {
        const auto of_step = static_cast<float>(1.0 - 1.5 * way.squaredNorm());
        for (std::size_t i = 0; i < 3; ++i) {
            const Lanes moment = static_cast<float>(way[static_cast<Eigen::Index>(i)]) * flux;
            slope[i] += moment;
            step[i] += of_step * moment;
        }
    }

    // Adds what a surface makes of light that it scatters by the same factor.
    void add_scattered(const KernelLight& light, const Lanes& factor) {
        full += light.full * factor;
        narrow += light.narrow * factor;
        photons += light.photons;
        for (std::size_t i = 0; i < 3; ++i) {
            slope[i] += light.slope[i] * factor;
            step[i] += light.step[i] * factor;
        }
    }
};

}  // namespace

bool in_kernel(const Stage& stage, const SurfacePoint& p, const SurfacePoint& q, double radius_m) {
    if ((p.position - q.position).squaredNorm() >= radius_m * radius_m) return false;
    // On curved sides the distance is longer than the chord.
    return p.object == no_object ||
           within_kernel(stage.parts().objects[p.object].shape, p, q, radius_m);
}

KernelAreas kernel_areas(const Stage& stage, const SurfacePoint& p, double radius_m) {
    const double disc = pi * radius_m * radius_m;
    if (p.object == no_object) return {disc, disc / 2.0};
    const Shape& shape = stage.parts().objects[p.object].shape;
    const double full = kernel_area_m2(shape, p, radius_m);
    // A whole disc holds the whole inner disc, which has half its area.
    if (full == disc) return {disc, disc / 2.0};
    return {full, kernel_area_m2(shape, p, inner_radius_factor * radius_m)};
}

double bias_per_difference(const KernelAreas& areas, double radius_m) {
    if (areas.flat_disc) return 1.0;
    const double disc = pi * square(inner_radius_factor * radius_m);
    const double lacks = std::clamp(1.0 - areas.inner / disc, 0.0, 0.5);
    return 2.0 + 2.0 * std::numbers::sqrt2 * lacks;  // to 1 / (1 - 1 / sqrt 2)
}

double cut_radius_m(const KernelAreas& areas, double radius_m, double share) {
    if (areas.flat_disc) return radius_m;
    const double left = areas.full / (pi * square(radius_m));
    const double whole = std::clamp(2.0 * left - 1.0, 0.0, 1.0);  // 0 at a straight rim
    return radius_m * (share + (1.0 - share) * whole);
}

Gathered KernelSums::over(const KernelAreas& areas, double radius_m, double rays) const {
    if (!(areas.full > 0.0)) return {};
    const Lanes radiance = full * static_cast<float>(1.0 / (rays * areas.full));
    // A sliver tells nothing of the bias but noise.
    constexpr double sliver = 0.125;
    if (areas.inner < sliver * areas.full) return {.radiance = radiance};
    const Lanes inside = narrow * static_cast<float>(1.0 / (rays * areas.inner));
    return {.radiance = radiance,
            .bias = static_cast<float>(bias_per_difference(areas, radius_m)) * (radiance - inside)};
}

Vec3 kernel_direction(const Frame& frame, const Vec3& normal, const Vec3& direction) {
    Vec3 wi = frame.to_local(-direction);
    const double cosine = -direction.dot(normal);
    const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
    const double across = std::sqrt(wi.x() * wi.x() + wi.y() * wi.y());
    const double stretch = across > 0.0 ? sine / across : 0.0;
    return {wi.x() * stretch, wi.y() * stretch, cosine};
}

ForwardMap::ForwardMap(const Stage& stage, const Radii& radii,
                       std::span<const std::vector<Photon>> photons, std::uint64_t rays,
                       int threads)
    : rays_(static_cast<double>(rays)) {
    std::vector<std::size_t> starts{0};  // of the lists
    for (const auto& list : photons) starts.push_back(starts.back() + list.size());
    const std::size_t count = starts.back();
    bucket_mask_ = std::bit_ceil(std::max<std::size_t>(2 * count, 16)) - 1;
    fluxes_ = RawArray<Lanes>(count);
    arrivals_ = RawArray<Arrival>(count);
    const std::size_t tasks = tasks_for(count);
    const auto emit = [&](std::size_t task, auto&& put) {
        const std::size_t end = (task + 1) * count / tasks;
        std::size_t i = task * count / tasks;
        auto list = static_cast<std::size_t>(std::ranges::upper_bound(starts, i) - starts.begin());
        for (; i < end; ++list) {
            for (; i < std::min(end, starts[list]); ++i) {
                const Photon& photon = photons[list - 1][i - starts[list - 1]];
                const std::uint32_t patch = kernel_patch(stage, photon.point);
                const PatchCells cells(patch, radii[patch]);
                put(cells.hash_at(photon.point.position) & bucket_mask_, &photon);
            }
        }
    };
    const auto place = [&](std::size_t i, const Photon* photon) {
        fluxes_.construct(i, photon->flux);
        arrivals_.construct(i, {photon->point, photon->direction, photon->light});
        return Candidate{photon->point.position.cast<float>(),
                         Candidate::key_of(kernel_patch(stage, photon->point),
                                           photon->direction.dot(photon->point.normal) < 0.0,
                                           photon->on_common_lane)};
    };
    grid_.build<const Photon*>(bucket_mask_ + 1, tasks, threads, emit, place);
    lay_lattices(stage, radii, photons);
}

// On each plane patch with photons, as the first of them tells in the order of the rays: not
// through it, as it would count there more often than others. The patches with the fewest points
// first.
void ForwardMap::lay_lattices(const Stage& stage, const Radii& radii,
                              std::span<const std::vector<Photon>> photons) {
    std::vector<const SurfacePoint*> first(stage.patch_count());
    std::vector<std::pair<double, std::uint32_t>> points_of_patches;
    for (const auto& list : photons) {
        for (const Photon& photon : list) {
            if (photon.point.object == no_object) continue;
            const std::uint32_t patch = stage.patch_index(photon.point);
            if (first[patch] || !stage.patch_is_plane(patch)) continue;
            first[patch] = &photon.point;
            points_of_patches.emplace_back(
                stage.patch_area_m2(patch) / square(spacing_per_radius * radii[patch]), patch);
        }
    }
    std::ranges::sort(points_of_patches);
    lattice_of_patch_.assign(stage.patch_count(), no_lattice);
    double points = 0.0;
    for (const auto& [of_patch, patch] : points_of_patches) {
        points += of_patch;
        if (points > most_lattice_points) break;
        lattice_of_patch_[patch] = static_cast<std::uint32_t>(lattices_.size());
        Lattice lattice{*first[patch], Frame(first[patch]->normal)};
        Vec3& origin = lattice.origin.position;
        const double spacing_m = spacing_per_radius * radii[patch];
        const Vec2 shift = spacing_m * Vec2(scrambled(origin), scrambled(-origin));
        origin += shift.x() * lattice.frame.tangent + shift.y() * lattice.frame.bitangent;
        lattices_.push_back(lattice);
    }
    // Tiles at the rims are not full.
    lattice_points_ = std::make_unique<KernelLattice>(
        static_cast<std::size_t>(2.0 * std::min(points, most_lattice_points)));
}

// The buckets of all cells that the kernel meets.
ForwardMap::Buckets ForwardMap::buckets_around(const Stage& stage, const GatherPoint& at,
                                               double cell_m, double radius_m) const {
    Buckets buckets;
    for_each_cell_of_kernel(stage, at.point, cell_m, radius_m, [&](std::uint64_t hash) {
        const std::size_t bucket = hash & bucket_mask_;
        const auto begin = buckets.numbers.begin();
        const auto end = begin + static_cast<std::ptrdiff_t>(buckets.count);
        if (std::find(begin, end, bucket) == end) buckets.numbers[buckets.count++] = bucket;
    });
    return buckets;
}

// Calls use(candidate, number of the photon, its weight in the narrow kernel).
template <typename Use>
void ForwardMap::for_each_in_kernel(const Stage& stage, const GatherPoint& at, double cell_m,
                                    double radius_m, bool flat_disc, const Use& use) const {
    const Vec3& centre = at.point.position;
    const std::uint32_t patch = kernel_patch(stage, at.point);
    const bool straight = is_straight(stage, at.point);
    const double inner_m = inner_radius_factor * radius_m;
    const double square_m2 = square(radius_m), inner_square_m2 = square(inner_m);
    // The quick test is in single precision and a little wide.
    const Eigen::Vector3f quick_centre = centre.cast<float>();
    const auto quick_m2 =
        static_cast<float>(square(1.0001 * radius_m + 1e-6 * centre.cwiseAbs().maxCoeff()));
    const Buckets buckets = buckets_around(stage, at, cell_m, radius_m);
    std::array<std::uint32_t, 64> near;
    for (std::size_t i = 0; i < buckets.count; ++i) {
        const std::span<const Candidate> bucket = grid_.bucket(buckets.numbers[i]);
        const std::size_t start = grid_.start(buckets.numbers[i]);
        for (std::size_t first = 0; first < bucket.size(); first += near.size()) {
            // Without a branch for each: which ones are near cannot be foreseen.
            const std::size_t end = std::min(bucket.size(), first + near.size());
            std::size_t found = 0;
            for (std::size_t k = first; k < end; ++k) {
                near[found] = static_cast<std::uint32_t>(k);
                found += (bucket[k].position - quick_centre).squaredNorm() < quick_m2 ? 1 : 0;
            }
            for (std::size_t k = 0; k < found; ++k) {
                const Candidate& candidate = bucket[near[k]];
                if (!(candidate.above() ? at.from_above : at.from_below)) continue;
                const std::size_t photon = start + near[k];
                const Arrival& arrival = arrivals_[photon];
                const double distance_m2 = (arrival.point.position - centre).squaredNorm();
                if (distance_m2 >= square_m2 || candidate.patch() != patch) continue;
                if (!straight && !in_kernel(stage, at.point, arrival.point, radius_m)) continue;
                if (at.region && !at.region->holds(arrival.point.position)) continue;
                if (at.but_of && (*at.but_of)[arrival.light]) continue;
                if (flat_disc) {
                    use(candidate, photon, narrow_weight(distance_m2 / square_m2));
                    continue;
                }
                const bool inner = distance_m2 < inner_square_m2 &&
                                   (straight || in_kernel(stage, at.point, arrival.point, inner_m));
                use(candidate, photon, inner ? 1.0 : 0.0);
            }
        }
    }
}

// Adds the flux on one side of a surface where distances are straight, by places in single
// precision. Returns the number of photons.
// @param key  that of photons on this side without the common hero.
std::uint32_t ForwardMap::add_by_place(const GatherPoint& at, const Buckets& buckets,
                                       std::uint32_t key, double radius_m, bool flat_disc,
                                       KernelSums& sums) const {
    const Eigen::Vector3f middle = at.point.position.cast<float>();
    const auto per_square_radius = static_cast<float>(1.0 / square(radius_m));
    constexpr auto inner_square = static_cast<float>(inner_radius_factor * inner_radius_factor);
    constexpr std::size_t most = 64;
    std::array<float, most> place;  // square of the distance from the centre in radii
    std::array<float, most> weight;
    std::array<std::uint32_t, most> near;
    std::uint32_t all = 0;
    for (std::size_t i = 0; i < buckets.count; ++i) {
        const std::span<const Candidate> bucket = grid_.bucket(buckets.numbers[i]);
        const std::size_t start = grid_.start(buckets.numbers[i]);
        for (std::size_t first = 0; first < bucket.size(); first += most) {
            const std::size_t count = std::min(most, bucket.size() - first);
            const Candidate* candidates = bucket.data() + first;
            for (std::size_t k = 0; k < count; ++k) {
                const Candidate& candidate = candidates[k];
                const float s = per_square_radius * (candidate.position - middle).squaredNorm();
                const bool here = (candidate.key & ~Candidate::common_bit) == key;
                place[k] = here ? s : 1.0f;
                weight[k] = narrow_weight(s);
            }
            if (!flat_disc) {
                for (std::size_t k = 0; k < count; ++k) {
                    weight[k] = place[k] < inner_square ? 1.0f : 0.0f;
                }
            }
            // Without a branch for each: which ones are near cannot be foreseen.
            std::size_t found = 0;
            for (std::size_t k = 0; k < count; ++k) {
                near[found] = static_cast<std::uint32_t>(k);
                found += place[k] < 1.0f ? 1 : 0;
            }
            if (at.region) {
                const auto outside = [&](std::uint32_t k) {
                    return !at.region->holds(candidates[k].position.cast<double>());
                };
                const auto end = near.begin() + static_cast<std::ptrdiff_t>(found);
                found = static_cast<std::size_t>(std::remove_if(near.begin(), end, outside) -
                                                 near.begin());
            }
            const Lanes* fluxes = fluxes_.data() + start + first;
            for (std::size_t k = 0; k < found; ++k) {
                const bool halved = at.optics.hero_only && candidates[near[k]].on_common_lane();
                const Lanes flux = (halved ? weight_of_common_heroes : 1.0f) * fluxes[near[k]];
                sums.full += flux;
                sums.narrow += weight[near[k]] * flux;
            }
            all += static_cast<std::uint32_t>(found);
        }
    }
    return all;
}

// In the kernel around the point itself.
Arriving ForwardMap::arriving(const Stage& stage, const GatherPoint& at, bool above, double cell_m,
                              double radius_m, const KernelAreas& areas) const {
    KernelSums sums;
    const std::uint32_t photons =
        add_by_place(at, buckets_around(stage, at, cell_m, radius_m),
                     Candidate::key_of(kernel_patch(stage, at.point), above, false), radius_m,
                     areas.flat_disc, sums);
    const Gathered light = sums.over(areas, radius_m, rays_);
    const double cut_off = areas.flat_disc ? 0.0 : 1.0 - areas.full / (pi * square(radius_m));
    return {light.radiance, light.bias, static_cast<float>(photons), static_cast<float>(cut_off)};
}

// Between points of the lattice, where so much is seen around them that it pays.
std::optional<Arriving> ForwardMap::arriving_between(const Stage& stage, const GatherPoint& at,
                                                     bool above, double radius_m,
                                                     double share_of_cut) const {
    const double spacing_m = spacing_per_radius * radius_m;
    if (!(at.seen_m2 <= most_seen_per_cell * square(spacing_m))) return std::nullopt;
    const std::uint32_t patch = kernel_patch(stage, at.point);
    if (lattice_of_patch_[patch] == no_lattice) return std::nullopt;
    const auto& [origin, frame] = lattices_[lattice_of_patch_[patch]];
    const Vec3 way = at.point.position - origin.position;
    // The normal of a mesh has the digits of its file, and tilts the lattice.
    const double off_plane_m =
        optics::off_plane_m(stage.parts().objects[origin.object].shape, radius_m);
    if (std::abs(way.dot(origin.normal)) > off_plane_m + stage.nudge_m()) return std::nullopt;
    const Vec3 along_x = spacing_m * frame.tangent, along_y = spacing_m * frame.bitangent;
    const auto gather = [&](int i, int j) -> std::optional<Arriving> {
        SurfacePoint point = origin;
        point.position += i * along_x + j * along_y;
        const GatherPoint there{point, at.frame, at.wo, at.bsdf, at.optics};
        const OwnKernel own = own_kernel(stage, there, radius_m, share_of_cut);
        // Only points of the patch; those in its corners are left out with those beyond.
        if (own.areas.full < 0.5 * pi * square(own.radius_m)) return std::nullopt;
        Arriving light = arriving(stage, there, above, radius_m, own.radius_m, own.areas);
        light.bias *= bias_of_interpolation(light.cut_off);
        return light;
    };
    return lattice_points_->between({patch, above, at.optics.hero_only},
                                    way.dot(frame.tangent) / spacing_m,
                                    way.dot(frame.bitangent) / spacing_m, gather);
}

// What a diffuse surface scatters, by places alone.
Gathered ForwardMap::gather_by_place(const Stage& stage, const GatherPoint& at, double cell_m,
                                     double radius_m, double share_of_cut, const Lanes& from_above,
                                     const Lanes& from_below) const {
    Gathered gathered;
    float photons = 0.0f;
    std::optional<OwnKernel> own;
    const auto add_side = [&](bool above, const Lanes& scattered) {
        std::optional<Arriving> light;
        float share = 1.0f;
        if (radius_m == cell_m) {
            light = arriving_between(stage, at, above, radius_m, share_of_cut);
        }
        if (light) {
            share = static_cast<float>(at.seen_m2 / square(spacing_per_radius * radius_m));
        } else {
            if (!own) own = own_kernel(stage, at, radius_m, share_of_cut);
            light = arriving(stage, at, above, cell_m, own->radius_m, own->areas);
        }
        gathered.radiance += light->density * scattered;
        gathered.bias += light->bias * scattered;
        gathered.summed += share * light->photons;
        photons += light->photons;
        if (light->cut_off > 0.0f && is_on_plane_patch(stage, at.point)) {
            gathered.left = 1.0f - light->cut_off;
        }
    };
    if (at.from_above && (from_above != 0.0f).any()) add_side(true, from_above);
    if (at.from_below && (from_below != 0.0f).any()) add_side(false, from_below);
    gathered.photons = static_cast<std::uint32_t>(photons + 0.5f);
    return gathered;
}

Gathered ForwardMap::gather(const Phase& phase, const Radii& radii, const GatherPoint& at) const {
    if (empty()) return {};
    const Stage& stage = phase.stage;
    const double cell_m = radii[kernel_patch(stage, at.point)];
    const double radius_m = std::min({cell_m, radii.of_point(at.sensor_point), at.most_radius_m});
    const auto scattered = [&](const Vec3& wi) {
        return evaluate(at.bsdf, at.optics, at.wo, wi, Transport::radiance);
    };
    const bool diffuse = std::holds_alternative<Diffuse>(at.bsdf);
    // All light from a side is scattered alike.
    const Lanes from_above = diffuse ? scattered(Vec3::UnitZ()) : Lanes::Zero();
    const Lanes from_below = diffuse ? scattered(-Vec3::UnitZ()) : Lanes::Zero();
    // Single precision tells places to 6e-8 of the coordinates.
    if (diffuse && !at.tells_steps && !at.but_of && is_straight(stage, at.point) &&
        radius_m > 1e-4 * at.point.position.cwiseAbs().maxCoeff()) {
        return gather_by_place(stage, at, cell_m, radius_m, radii.share_of_cut(), from_above,
                               from_below);
    }
    const KernelAreas areas = areas_left(stage, at, radius_m);
    const bool tells_steps = at.tells_steps && areas.flat_disc;
    const auto add = [&](KernelLight& to, const Lanes& flux, const Candidate& candidate,
                         std::size_t photon, double weight) {
        ++to.photons;
        const bool halved = at.optics.hero_only && candidate.on_common_lane();
        const Lanes part = halved ? Lanes(flux * weight_of_common_heroes) : flux;
        to.full += part;
        to.narrow += static_cast<float>(weight) * part;
        if (!tells_steps) return;
        to.add_moments(part, (arrivals_[photon].point.position - at.point.position) / radius_m);
    };
    KernelLight sum;
    if (diffuse) {
        KernelLight above, below;
        for_each_in_kernel(stage, at, cell_m, radius_m, areas.flat_disc,
                           [&](const Candidate& candidate, std::size_t photon, double weight) {
                               add(candidate.above() ? above : below, fluxes_[photon], candidate,
                                   photon, weight);
                           });
        sum.add_scattered(above, from_above);
        sum.add_scattered(below, from_below);
    } else {
        for_each_in_kernel(stage, at, cell_m, radius_m, areas.flat_disc,
                           [&](const Candidate& candidate, std::size_t photon, double weight) {
                               const Arrival& arrival = arrivals_[photon];
                               const Vec3 wi = kernel_direction(at.frame, arrival.point.normal,
                                                                arrival.direction);
                               add(sum, fluxes_[photon] * scattered(wi), candidate, photon, weight);
                           });
    }
    if (sum.photons == 0) return {};
    Gathered gathered = sum.over(areas, radius_m, rays_);
    gathered.photons = sum.photons;
    gathered.summed = static_cast<float>(sum.photons);
    if (!tells_steps) return gathered;
    const double per_sum = 1.0 / (rays_ * areas.full);
    for (std::size_t i = 0; i < 3; ++i) {
        gathered.slope[i] = static_cast<float>(per_sum) * sum.slope[i];
        gathered.step[i] = static_cast<float>(bias_per_moment_of_step * per_sum) * sum.step[i];
    }
    return gathered;
}

}  // namespace lucerna::optics
