// The backward photon map (docs/method.md eq. 3): vertices of backward rays that collect the flux
// of forward rays hitting their surroundings.
#pragma once

#include <memory>
#include <vector>

#include "optics/transport/cell_grid.h"
#include "optics/transport/forward_map.h"

namespace lucerna::optics {

/// A vertex of a backward ray.
struct BackwardPhoton {
    SurfacePoint point;
    Vec3 wo;           ///< local direction toward the observer
    Lanes throughput;  ///< filter from here to the observer, BSDF weights included
    BsdfId bsdf;
    ObjectId medium_above, medium_below;
    std::uint32_t bin;     ///< of the readings
    std::uint8_t accepts;  ///< History values, or-ed
    bool hero_only;        ///< see Path
    std::uint8_t hero;
};

/// Filled by forward rays and then read once. By find() and apply() the sums of a backward photon
/// are written by one thread at a time and in the order of the rays, so that they do not depend on
/// the number of threads.
class BackwardMap {
public:
    BackwardMap() = default;
    /// @param blocks  backward photons of blocks of observer samples, in order.
    BackwardMap(const Phase& phase, const Radii& radii,
                std::vector<std::vector<BackwardPhoton>> blocks, int threads);

    /// What a block of forward rays left to deposit, sorted by the part of the map that it goes to.
    struct Deposits {
        std::vector<Photon> photons;
        struct Pair {
            std::uint32_t backward_photon, photon;
        };
        std::array<std::vector<Pair>, 64> by_part;
    };
    static constexpr std::size_t parts = 64;

    /// Looks up the backward photons that a photon falls into; read-only, safe for concurrent use.
    void find(const Photon& photon, Deposits& deposits) const;

    /// Adds the deposits of a part of the map, blocks in order; parts may run concurrently.
    /// Returns the number of deposits.
    std::uint64_t apply(std::size_t part, std::span<const Deposits> blocks);

    /// Finds and adds at once, each backward photon under a lock; safe for concurrent use, but the
    /// order of the sums is that of the threads. Returns the number of deposits.
    std::uint64_t deposit_locked(const Photon& photon);

    /// Calls read(bin, radiance, bias of it) for each backward photon of a block of observer
    /// samples, in order; `rays` is the number of forward rays traced.
    template <typename Read>
    void read(std::size_t block, std::uint64_t rays, Read&& read) const {
        for (std::size_t i = block_starts_[block]; i < block_starts_[block + 1]; ++i) {
            if (!touched_[i]) continue;
            const Gathered sum = radiance(i, rays);
            read(photons_[i].bin, sum.radiance, sum.bias);
        }
    }

    std::size_t size() const { return photons_.size(); }
    std::size_t bytes() const;

private:
    // A backward photon as it stands in a bucket of the hashed grid: 16 bytes, for the cache. Cells
    // that share a bucket are told apart by distance and patch; no photon stands twice in one
    // bucket.
    struct Candidate {
        Eigen::Vector3f position;
        std::uint32_t index;
    };
    void build_grid(int threads);
    template <typename Use>
    void for_each_around(const Photon& photon, Use&& use) const;
    void add(std::uint32_t index, const Photon& photon);

    Gathered radiance(std::size_t i, std::uint64_t rays) const;
    std::size_t part_of(std::uint32_t i) const { return i * parts / photons_.size(); }

    const Phase* phase_ = nullptr;
    const Radii* radii_ = nullptr;
    RawArray<BackwardPhoton> photons_;
    std::uint8_t accepted_ = 0;  // by any of them
    std::vector<std::size_t> block_starts_;
    RawArray<KernelSums> sums_;  // of f dPhi, by two radii
    RawArray<std::uint8_t> touched_;
    std::size_t bucket_mask_ = 0;
    BucketTable<Candidate> grid_;  // each photon stands in all cells that its kernel meets
    struct Locks;
    std::shared_ptr<Locks> locks_;
};

}  // namespace lucerna::optics
