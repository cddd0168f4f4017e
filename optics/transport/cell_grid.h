// Points on patches found by place: a hashed grid with a cell size per patch.
#pragma once

#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "core/vector.h"

namespace lucerna::optics {

/// A cell of the grid of one patch. Comparing it is exact; only the bucket is a hash.
struct CellKey {
    std::uint32_t patch;
    std::int32_t x, y, z;

    bool operator==(const CellKey&) const = default;

    static CellKey at(std::uint32_t patch, const Vec3& position, double cell_m) {
        const auto index = [&](double coordinate) {
            return static_cast<std::int32_t>(std::floor(coordinate / cell_m));
        };
        return {patch, index(position.x()), index(position.y()), index(position.z())};
    }

    std::uint64_t hash() const {
        // Mixing steps of MurmurHash3's finaliser over the packed coordinates.
        std::uint64_t h = patch * 0x9E3779B97F4A7C15ull;
        for (const std::int32_t c : {x, y, z}) {
            h ^= static_cast<std::uint32_t>(c);
            h *= 0xFF51AFD7ED558CCDull;
            h ^= h >> 32;
        }
        return h;
    }
};

/// Items sorted into buckets by counting; the order within a bucket is that of insertion, so that a
/// sum over a bucket does not depend on threads.
template <typename Item>
class CellGrid {
public:
    struct Entry {
        CellKey key;
        Item item;
    };

    void build(std::vector<Entry> entries) {
        const std::size_t buckets = std::bit_ceil(std::max<std::size_t>(2 * entries.size(), 16));
        mask_ = buckets - 1;
        starts_.assign(buckets + 1, 0);
        for (const Entry& entry : entries) ++starts_[(entry.key.hash() & mask_) + 1];
        for (std::size_t i = 1; i <= buckets; ++i) starts_[i] += starts_[i - 1];
        sorted_.resize(entries.size());
        std::vector<std::uint32_t> next(starts_.begin(), starts_.end() - 1);
        for (const Entry& entry : entries) sorted_[next[entry.key.hash() & mask_]++] = entry;
    }

    /// Calls found(item) for the items in a cell, in order of insertion.
    template <typename Found>
    void visit(const CellKey& key, Found&& found) const {
        if (sorted_.empty()) return;
        const std::size_t bucket = key.hash() & mask_;
        for (std::uint32_t i = starts_[bucket]; i < starts_[bucket + 1]; ++i) {
            if (sorted_[i].key == key) found(sorted_[i].item);
        }
    }

    /// Calls use(item) for all items, in the order of their places in memory.
    template <typename Use>
    void for_each(Use&& use) {
        for (Entry& entry : sorted_) use(entry.item);
    }

    std::size_t bytes() const {
        return starts_.size() * sizeof(std::uint32_t) + sorted_.size() * sizeof(Entry);
    }

private:
    std::size_t mask_ = 0;
    std::vector<std::uint32_t> starts_;
    std::vector<Entry> sorted_;
};

}  // namespace lucerna::optics
