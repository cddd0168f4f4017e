#include "optics/transport/forward_maps.h"

#include <algorithm>

namespace lucerna::optics {

ForwardMaps::Found ForwardMaps::gather(const Phase& phase, const GatherPoint& at,
                                       std::uint8_t histories, double kernel_scale,
                                       bool barriers) const {
    const std::uint32_t patch = kernel_patch(phase.stage, at.point);
    const bool of_caustics = (histories & mask(History::caustic)) && !caustic.empty();
    const bool of_indirect = (histories & mask(History::indirect)) && !indirect.empty();
    GatherPoint narrow = at, wide = at;
    wide.but_of = nullptr;
    narrow.from_above = narrow.from_below = true;
    if (of_indirect) {
        wide.most_radius_m = std::min(at.most_radius_m, kernel_scale * indirect_radii[patch]);
    }
    Found found;
    std::optional<KernelRegion> region;
    if (barriers && (of_caustics || of_indirect)) {
        const double radius_m =
            std::max(of_caustics ? std::min(at.most_radius_m, caustic_radii[patch]) : 0.0,
                     of_indirect ? wide.most_radius_m : 0.0);
        const Vec3 side = at.wo.z() > 0.0 ? at.frame.normal : Vec3(-at.frame.normal);
        // Kernels of the points of a lattice reach further.
        const auto within = [&](double reach_m) {
            return KernelRegion::within(phase.stage, at.point, side, reach_m);
        };
        if (within(reach_of_lattice * radius_m)) {
            found.cut = true;
            narrow.seen_m2 = wide.seen_m2 = infinity;
            region = within(radius_m);
            if (region) narrow.region = wide.region = &*region;
        }
    }
    if (of_caustics) {
        found.light = caustic.gather(phase, caustic_radii, narrow);
        found.caustic_summed = found.light.summed;
    }
    if (of_indirect) {
        const Gathered light = indirect.gather(phase, indirect_radii, wide);
        found.indirect = light.radiance;
        found.indirect_bias = light.bias;
        found.indirect_photons = light.photons;
        found.indirect_summed = light.summed;
        found.indirect_left = light.left;
        found.light += light;
    }
    return found;
}

}  // namespace lucerna::optics
