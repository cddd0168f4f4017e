#include "optics/transport/pilot_light.h"

#include <algorithm>

#include "core/parallel.h"
#include "optics/transport/forward_map.h"

namespace lucerna::optics {
namespace {

// In a unit in which photons of equal flux have 1.
void normalise(std::vector<Arrival>& photons) {
    double sum = 0.0, squares = 0.0;
    for (const Arrival& photon : photons) {
        sum += photon.flux;
        squares += photon.flux * photon.flux;
    }
    if (!(squares > 0.0)) return;
    for (Arrival& photon : photons) photon.flux *= sum / squares;
}

double limit_of_surface_m(const Stage& stage, std::uint32_t patch, double radii_per_size) {
    return std::min(stage.caster().scene_radius_m() / 20.0,
                    std::sqrt(stage.patch_area_m2(patch)) / radii_per_size);
}

}  // namespace

LightByRadius LightByRadius::around(const Vec3& point, const std::vector<Arrival>& photons,
                                    double limit_m) {
    LightByRadius light;
    for (const Arrival& photon : photons) {
        const Vec3 way = (photon.position - point) / limit_m;
        const double square = way.squaredNorm();
        if (square >= 1.0 || square == 0.0) continue;
        // Between 2^-step and half of it.
        const auto step = std::min(static_cast<std::size_t>(-1 - std::ilogb(square)), steps);
        light.flux[step] += photon.flux;
        light.squares[step] += photon.flux * photon.flux;
        light.moment[step] += photon.flux * way;
        light.third_moment[step] += photon.flux * square * way;
    }
    for (std::size_t i = steps; i > 0; --i) {
        light.flux[i - 1] += light.flux[i];
        light.squares[i - 1] += light.squares[i];
        light.moment[i - 1] += light.moment[i];
        light.third_moment[i - 1] += light.third_moment[i];
    }
    return light;
}

std::vector<LightByRadius> LightByRadius::around(const std::vector<Vec3>& points,
                                                 const std::vector<Arrival>& photons,
                                                 double limit_m, int threads) {
    std::vector<LightByRadius> lights(points.size());
    for_each_block(points.size(), threads,
                   [&](std::size_t i) { lights[i] = around(points[i], photons, limit_m); });
    return lights;
}

std::vector<std::vector<Arrival>> arrivals_by_patch(const Stage& stage, const SensorPlanes& planes,
                                                    const PilotPhotons& pilot) {
    std::vector<std::vector<Arrival>> arrivals(stage.patch_count() + planes.count());
    for (const Photon& photon : pilot.photons) {
        arrivals[kernel_patch(stage, photon.point)].push_back(
            {photon.point.position, luminous_flux(pilot.luminance, photon)});
    }
    for (auto& of_patch : arrivals) normalise(of_patch);
    return arrivals;
}

double limit_of_patch_m(const Stage& stage, const SensorPlanes& planes, std::uint32_t patch) {
    return patch >= stage.patch_count() ? planes.margin_m() : limit_of_surface_m(stage, patch, 8.0);
}

double limit_of_seen_patch_m(const Stage& stage, const SensorPlanes& planes, std::uint32_t patch) {
    return patch < stage.patch_count() && stage.patch_is_plane(patch)
               ? limit_of_surface_m(stage, patch, 4.0)
               : limit_of_patch_m(stage, planes, patch);
}

}  // namespace lucerna::optics
