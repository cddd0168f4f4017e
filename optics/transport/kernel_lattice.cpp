#include "optics/transport/kernel_lattice.h"

#include <algorithm>
#include <bit>

namespace lucerna::optics {

KernelLattice::KernelLattice(std::size_t points)
    : points_(std::bit_ceil(std::max<std::size_t>(points, edge * edge))),
      tiles_(std::make_unique<Tile[]>(tile_count())) {}

std::uint64_t KernelLattice::key_of(const Side& side, int i, int j) {
    const auto packed = [](int index) {
        return static_cast<std::uint64_t>((index + (1 << 19)) / edge);
    };
    return std::uint64_t{side.patch} << 42 | (side.above ? 1ull << 41 : 0) |
           (side.hero_only ? 1ull << 40 : 0) | packed(i) << 20 | packed(j);
}

std::size_t KernelLattice::find_tile(std::uint64_t key) const {
    const std::size_t mask = tile_count() - 1;
    std::uint64_t hash = key * 0x9E3779B97F4A7C15ull;
    hash = (hash ^ hash >> 32) * 0x9E3779B97F4A7C15ull;  // the patch stands in its upper bits
    std::size_t tile = hash >> 32;
    for (std::size_t step = 0; step < most_steps; ++step, ++tile) {
        tile &= mask;
        std::uint64_t found = tiles_[tile].key.load(std::memory_order_relaxed);
        if (found == 0) tiles_[tile].key.compare_exchange_strong(found, key);
        if (found == 0 || found == key) return tile;
    }
    return tile_count();
}

}  // namespace lucerna::optics
