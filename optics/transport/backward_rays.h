// How many backward rays each bin gets in a phase, and with which kernels they gather.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>

#include "optics/transport/readings.h"
#include "optics/transport/square_density.h"

namespace lucerna::optics {

/// Bins whose rays one task traces.
struct BinBlock {
    std::size_t observer_bins;  ///< index of the ObserverBins
    std::size_t first, last;    ///< bins within the observer, last excluded
};

/// From where indirect light arrives at the points of one side of a patch: a density over the two
/// numbers that sample_cosine_hemisphere() makes directions of.
struct ArrivalDensity {
    std::uint32_t patch = 0;  ///< see kernel_patch()
    bool above = true;        ///< its side
    SquareDensity density;
};

/// The backward rays of a bin in a phase.
struct BinRays {
    std::uint32_t count;
    /// Of those that see the same surface, one gathers photons for this many: in a large image
    /// kernels are wider than pixels, and what the other rays of a pixel would find is nearly the
    /// same.
    std::uint32_t per_gather;
    std::uint32_t first_path;  ///< number of the first of them
    /// Radii of their kernels of indirect light over those of the surface.
    double kernel_scale;
    bool barriers;  ///< whether their kernels are looked through for barriers
    double pixels;  ///< that the bin stands for: in pilots, those of a tile
    /// Where they are scattered to at their first event, if that is on the patch; else nullptr.
    const ArrivalDensity* arrivals;
    /// Of each light: whether rays that the first event scatters count its emission behind specular
    /// events, and its photons are left out of what is gathered there. nullptr: of none.
    const std::vector<bool>* looks_for;
};

/// What the single rays of a bin read: the number of rays, and sums over them.
struct RaySums {
    float rays = 0.0f, luminance = 0.0f, square = 0.0f;
    float segments = 0.0f;     ///< of their paths, shadow rays included
    float kernel_bias = 0.0f;  ///< of the luminance gathered from the map of indirect light
    float kernel_bias_variance = 0.0f;                    ///< of it, at least
    float barriers = 0.0f;                                ///< number of kernels that barriers cut
    float caustic_summed = 0.0f, indirect_summed = 0.0f;  ///< photons, see Gathered

    RaySums& operator+=(const RaySums& other) {
        rays += other.rays;
        luminance += other.luminance;
        square += other.square;
        segments += other.segments;
        kernel_bias += other.kernel_bias;
        kernel_bias_variance += other.kernel_bias_variance;
        barriers += other.barriers;
        caustic_summed += other.caustic_summed;
        indirect_summed += other.indirect_summed;
        return *this;
    }
};

/// The i-th of `count` among `all` blocks: one of each of as many equal parts, but not the same one
/// of each, as blocks at equal distances may stand below each other in an image.
inline std::size_t spread_out(std::size_t i, std::size_t count, std::size_t all) {
    constexpr double golden_ratio = 0.6180339887498949;
    const double turns = golden_ratio * static_cast<double>(i);
    const std::size_t first = i * all / count, end = (i + 1) * all / count;
    return first +
           static_cast<std::size_t>((turns - std::floor(turns)) * static_cast<double>(end - first));
}

/// The rays and kernels of each bin, the same in all phases: they must not follow what phases find.
class BackwardRays {
public:
    BackwardRays() = default;  ///< none
    /// The same for all bins of an observer.
    BackwardRays(const SceneParts& parts, const Readings& readings, const Settings& settings);

    /// So many for each pixel, fewer in large images, and none for sensors: to find out what a
    /// pixel needs.
    static BackwardRays of_pilot(const SceneParts& parts, const Readings& readings,
                                 std::uint32_t per_pixel);

    /// One ray through each square tile of an image, a pixel or some.
    static BackwardRays through_tiles(const SceneParts& parts, const Readings& readings);

    BinRays of(std::size_t observer_bins, std::size_t bin) const {
        const Shares& own = observers_[observer_bins];
        const std::uint32_t count = own.count_of(bin);
        return {count,
                std::min(count, own.shared),
                own.first_path + static_cast<std::uint32_t>(bin) * own.most,
                own.kernels.empty() ? 1.0 : double{own.kernels[bin].scale},
                own.kernels.empty() ? own.looks_for_barriers : own.kernels[bin].barriers,
                static_cast<double>(own.tile * own.tile),
                own.arrivals.empty() ? nullptr : &own.arrivals[bin / own.bins_per_arrivals],
                own.looks_for.empty() ? nullptr : &own.looks_for};
    }
    const std::vector<BinBlock>& blocks() const { return blocks_; }
    std::uint64_t per_phase() const { return total_; }
    /// At most so many blocks, spread evenly over all images.
    std::vector<BinBlock> some_of_images(const SceneParts& parts, const Readings& readings,
                                         std::size_t most) const;
    /// Largest number of rays that one gathers for where all pixels have as many.
    std::uint32_t per_gather() const;
    std::size_t bytes() const;

    /// Gives more rays to pixels whose rays differ most for what they cost: with n ~ standard
    /// deviation of a ray / sqrt(its cost) the sum of the variances of all pixels is least for the
    /// cost (Neyman, J. R. Stat. Soc. 97, 1934, 558; Cochran, Sampling Techniques, 3rd ed.,
    /// eq. 5.21). Half of an image's rays are shared out evenly; four in five of them, and twice as
    /// many in all, if noise is everywhere, which a pilot phase does not measure well.
    /// @param sums  per bin, of the rays of a pilot phase.
    void share_out(const SceneParts& parts, const Readings& readings,
                   const std::vector<RaySums>& sums, bool noise_everywhere, int threads);

    /// Looks for kernels that barriers cut, and narrows those of pixels where the surface's are
    /// shown to be biased, as beside an edge of shadow: so far that the sum of the squares of noise
    /// and bias becomes least.
    /// @param pilots  of each of some pilot phases with as many photons as those of a run: per bin,
    ///                what the rays of through_tiles() read. A single one shows no bias.
    void look_at_kernels(const SceneParts& parts, const Readings& readings,
                         std::span<const std::vector<RaySums>> pilots, int threads);
    /// The same kernels as those of other rays of the same observers.
    void take_kernels(const BackwardRays& other);

    /// Scatters the rays of an observer's bins to where light arrives from.
    /// @param bins_per_arrivals  neighbouring bins that share a density.
    void guide(std::size_t observer_bins, std::vector<ArrivalDensity> arrivals,
               std::size_t bins_per_arrivals) {
        observers_[observer_bins].arrivals = std::move(arrivals);
        observers_[observer_bins].bins_per_arrivals = bins_per_arrivals;
    }

    /// Lets the rays of an observer look for lights behind specular events, see BinRays; an empty
    /// list for none.
    void look_for(std::size_t observer_bins, std::vector<bool> lights) {
        observers_[observer_bins].looks_for = std::move(lights);
    }
    const std::vector<bool>& looks_for(std::size_t observer_bins) const {
        return observers_[observer_bins].looks_for;
    }
    /// Whether all observers look for all lights, so that nobody gathers caustics.
    bool look_for_all() const {
        return std::ranges::all_of(observers_, [](const Shares& own) {
            return !own.looks_for.empty() &&
                   std::ranges::find(own.looks_for, false) == own.looks_for.end();
        });
    }

private:
    struct Kernel {
        float scale = 1.0f;
        bool barriers = false;
    };
    struct Shares {
        std::uint32_t even;
        std::uint32_t per_gather;  // of the even number, for which maps have their photons
        std::uint32_t shared;      // rays of any pixel that share a gather at most
        std::uint32_t most;        // rays that any bin may have
        std::uint32_t first_path = 0;
        std::vector<std::uint8_t> log2 = {};  // of each bin's number; empty if it is `even` for all
        std::vector<Kernel> kernels = {};     // of each bin; empty if nothing is known of them
        std::vector<ArrivalDensity> arrivals = {};  // each of some bins; empty if none is known
        std::size_t bins_per_arrivals = 1;
        std::vector<bool> looks_for = {};
        bool looks_for_barriers = true;  // while nothing is known
        // Of an image only the pixels in the middles of tiles have rays.
        std::size_t tile = 1, width = 1;

        std::uint32_t count_of(std::size_t bin) const {
            if (!log2.empty()) return 1u << log2[bin];
            if (tile == 1) return even;
            const auto in_middle = [&](std::size_t i) { return i % tile == tile / 2; };
            return in_middle(bin % width) && in_middle(bin / width) ? even : 0;
        }
    };
    void number(const Readings& readings);

    std::vector<Shares> observers_;  // per ObserverBins
    std::vector<BinBlock> blocks_;
    std::uint64_t total_ = 0;
};

}  // namespace lucerna::optics
