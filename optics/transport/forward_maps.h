// The forward maps of a phase, and what rays gather from both at once.
#pragma once

#include "optics/transport/forward_map.h"

namespace lucerna::optics {

/// The maps that are gathered at the first scattering event. Each history has a map of its own:
/// caustics are narrow and need narrow kernels, indirect light is smooth and bears wide ones.
struct ForwardMaps {
    ForwardMap caustic, indirect;
    Radii caustic_radii, indirect_radii;

    struct Found {
        Gathered light;                       ///< of both maps
        Lanes indirect = Lanes::Zero();       ///< radiance from the indirect map alone
        Lanes indirect_bias = Lanes::Zero();  ///< of it
        std::uint32_t indirect_photons = 0;   ///< in the kernel
        float caustic_summed = 0.0f, indirect_summed = 0.0f;  ///< see Gathered
        bool cut = false;                                     ///< by barriers
        float indirect_left = 1.0f;                           ///< see Gathered
    };

    /// Light of the given histories, or-ed, at a point.
    /// @param at            `but_of` counts for caustics alone.
    /// @param kernel_scale  radii of kernels of indirect light over those of the map.
    /// @param barriers      whether to look for what stands on the surface within the kernels.
    Found gather(const Phase& phase, const GatherPoint& at, std::uint8_t histories,
                 double kernel_scale, bool barriers) const;
};

}  // namespace lucerna::optics
