// The two-level scheduler (docs/method.md): groups of threads, each with the backward map of its
// own part of the image, that also deposit into each other's maps.
#pragma once

#include "optics/transport/phase_trace.h"

namespace lucerna::optics {

/// Backward trace, backward maps and secondary trace of a phase, by groups of threads that never
/// wait for each other before all of the phase is done. Each map takes a number of rays that is
/// fixed beforehand, of whichever group: what it reads is normalised by that number, and no
/// schedule can bias it. Which rays those are depends on the threads, and so do the bits.
void trace_in_groups(const Phase& phase, const TraceContext& context, const Plan& plan,
                     std::span<const BinBlock> blocks, const ForwardMaps& maps,
                     const Radii& hidden_radii, PhaseTrace& trace);

}  // namespace lucerna::optics
