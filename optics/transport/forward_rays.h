// How many forward rays a phase traces for the maps that images gather from.
#pragma once

#include "optics/transport/phase_trace.h"

namespace lucerna::optics {

/// What single rays of a kind are worth to the images, or photons of a map.
struct NoiseAndCost {
    double variance = 0.0;  ///< of the sum over pixels, of all of them in a phase
    double cost = 0.0;      ///< of all of them, in segments of paths
};

/// Number of forward rays with which the product of variance and cost is least, for a map whose
/// `rays` rays have the noise and cost `of_map` beside backward rays with `of_backward`:
///     n = N sqrt(A t_B / (B t_F))                                          docs/method.md eq. 7
/// where A and B are the variances, t_F and t_B the costs.
double rays_that_pay(double rays, const NoiseAndCost& of_map, const NoiseAndCost& of_backward);

/// Sets the numbers of forward rays of the plan's maps by what they bring in pilot phases, unless
/// the user states them. Maps that sensors gather from keep theirs, to which kernels were fitted.
/// @param pilot_number  of the pilot phase; it takes random numbers of the one before, too.
void choose_forward_rays(const TraceContext& context, const Settings& settings,
                         std::uint32_t pilot_number, Plan& plan);

}  // namespace lucerna::optics
