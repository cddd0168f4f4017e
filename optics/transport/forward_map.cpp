#include "optics/transport/forward_map.h"

#include <algorithm>
#include <bit>
#include <numbers>

#include "optics/transport/path.h"

namespace lucerna::optics {
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
    const double disc = pi * square(inner_radius_factor * radius_m);
    const double lacks = std::clamp(1.0 - areas.inner / disc, 0.0, 0.5);
    return 2.0 + 2.0 * std::numbers::sqrt2 * lacks;  // to 1 / (1 - 1 / sqrt 2)
}

Gathered KernelSums::over(const KernelAreas& areas, double radius_m, double rays) const {
    if (!(areas.inner > 0.0)) return {};
    const Lanes radiance = full * static_cast<float>(1.0 / (rays * areas.full));
    const Lanes inside = inner * static_cast<float>(1.0 / (rays * areas.inner));
    return {radiance,
            static_cast<float>(bias_per_difference(areas, radius_m)) * (radiance - inside)};
}

Vec3 kernel_direction(const Frame& frame, const Photon& photon) {
    Vec3 wi = frame.to_local(-photon.direction);
    const double cosine = -photon.direction.dot(photon.point.normal);
    const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
    const double across = std::sqrt(wi.x() * wi.x() + wi.y() * wi.y());
    const double stretch = across > 0.0 ? sine / across : 0.0;
    return {wi.x() * stretch, wi.y() * stretch, cosine};
}

ForwardMap::ForwardMap(const Stage& stage, const Radii& radii, const std::vector<Photon>& photons,
                       std::uint64_t rays, int threads)
    : bucket_mask_(std::bit_ceil(std::max<std::size_t>(2 * photons.size(), 16)) - 1),
      photons_(photons.size()),
      rays_(static_cast<double>(rays)) {
    const std::size_t blocks = (photons.size() + photons_per_task - 1) / photons_per_task;
    grid_.build(bucket_mask_ + 1, blocks, threads, [&](std::size_t block, auto&& put) {
        const std::size_t end = std::min(photons.size(), (block + 1) * photons_per_task);
        for (std::size_t i = block * photons_per_task; i < end; ++i) {
            const Vec3& position = photons[i].point.position;
            const std::uint32_t patch = kernel_patch(stage, photons[i].point);
            const CellKey cell = CellKey::at(patch, position, 2.0 * radii[patch]);
            put(cell.hash() & bucket_mask_, {cell, position, static_cast<std::uint32_t>(i)});
        }
    });
    const std::span<Place> places = grid_.items();
    for_each_block(blocks, threads, [&](std::size_t block) {
        const std::size_t end = std::min(photons.size(), (block + 1) * photons_per_task);
        for (std::size_t i = block * photons_per_task; i < end; ++i) {
            photons_[i] = photons[places[i].photon];
            places[i].photon = static_cast<std::uint32_t>(i);
        }
    });
}

Gathered ForwardMap::gather(const Phase& phase, const Radii& radii, const GatherPoint& at) const {
    KernelSums sum;
    if (photons_.empty()) return {};
    const Stage& stage = phase.stage;
    const std::uint32_t patch = kernel_patch(stage, at.point);
    const double cell_m = 2.0 * radii[patch];
    const double radius_m =
        std::min({radii[patch], radii.of_point(at.sensor_point), at.most_radius_m});
    const double inner_m = inner_radius_factor * radius_m;
    const Vec3 reach = Vec3::Constant(radius_m);
    const CellKey low = CellKey::at(patch, at.point.position - reach, cell_m);
    const CellKey high = CellKey::at(patch, at.point.position + reach, cell_m);
    const double square_m2 = square(radius_m);
    const double inner_square_m2 = square(inner_m);
    // Elsewhere the distance along the surface may be longer than the straight one.
    const bool straight = at.point.object == no_object ||
                          !unrolls(stage.parts().objects[at.point.object].shape, at.point.patch);
    // A diffuse surface scatters all light from a side alike.
    const bool diffuse = std::holds_alternative<Diffuse>(at.bsdf);
    const auto scattered = [&](const Vec3& wi) {
        return evaluate(at.bsdf, at.optics, at.wo, wi, Transport::radiance);
    };
    const Lanes from_above = diffuse ? scattered(Vec3::UnitZ()) : Lanes::Zero();
    const Lanes from_below = diffuse ? scattered(-Vec3::UnitZ()) : Lanes::Zero();
    bool found = false;
    for (std::int32_t x = low.x; x <= high.x; ++x) {
        for (std::int32_t y = low.y; y <= high.y; ++y) {
            for (std::int32_t z = low.z; z <= high.z; ++z) {
                const CellKey cell{patch, x, y, z};
                for (const Place& place : grid_.bucket(cell.hash() & bucket_mask_)) {
                    if (place.cell != cell) continue;
                    const double distance_m2 = (at.point.position - place.position).squaredNorm();
                    if (distance_m2 >= square_m2) continue;
                    const Photon& photon = photons_[place.photon];
                    if (!straight && !in_kernel(stage, at.point, photon.point, radius_m)) continue;
                    if (at.region && !at.region->holds(place.position)) continue;
                    found = true;
                    const bool above = photon.direction.dot(photon.point.normal) < 0.0;
                    Lanes light =
                        photon.flux * (diffuse ? (above ? from_above : from_below)
                                               : scattered(kernel_direction(at.frame, photon)));
                    if (photon.on_common_lane && at.optics.hero_only) {
                        light *= weight_of_common_heroes;
                    }
                    sum.full += light;
                    if (distance_m2 < inner_square_m2 &&
                        (straight || in_kernel(stage, at.point, photon.point, inner_m))) {
                        sum.inner += light;
                    }
                }
            }
        }
    }
    if (!found) return {};
    const KernelAreas areas =
        at.region ? KernelAreas{at.region->area_m2(radius_m), at.region->area_m2(inner_m)}
                  : kernel_areas(stage, at.point, radius_m);
    return sum.over(areas, radius_m, rays_);
}

}  // namespace lucerna::optics
