// Points on patches found by place: a hashed grid with a cell size per patch.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/parallel.h"
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

/// Photons that one task puts into a table.
inline constexpr std::size_t photons_per_task = 1 << 14;

/// Items sorted into buckets by counting. The order within a bucket is that of the blocks and
/// within them that of insertion, so that a sum over a bucket does not depend on threads.
template <typename Item>
class BucketTable {
public:
    /// @param bucket_count  a power of two.
    /// @param emit  emit(block, put) calls put(bucket, item) for the items of a block, with bucket
    ///              below bucket_count; blocks may run concurrently.
    template <typename Emit>
    void build(std::size_t bucket_count, std::size_t blocks, int threads, const Emit& emit) {
        // First by range of buckets, block by block; then within each range.
        struct Placed {
            std::uint32_t bucket;
            Item item;
        };
        const std::size_t range_size = std::max<std::size_t>(1, bucket_count / ranges);
        std::vector<std::array<std::vector<Placed>, ranges>> by_range(blocks);
        for_each_block(blocks, threads, [&](std::size_t block) {
            emit(block, [&](std::size_t bucket, const Item& item) {
                by_range[block][bucket / range_size].push_back(
                    {static_cast<std::uint32_t>(bucket), item});
            });
        });
        std::array<std::uint32_t, ranges + 1> first{};
        for (std::size_t range = 0; range < ranges; ++range) {
            first[range + 1] = first[range];
            for (const auto& block : by_range) {
                first[range + 1] += static_cast<std::uint32_t>(block[range].size());
            }
        }
        starts_.resize(bucket_count + 1);
        starts_.back() = first.back();
        items_.resize(first.back());
        for_each_block(ranges, threads, [&](std::size_t range) {
            const std::size_t begin = std::min(bucket_count, range * range_size);
            const std::size_t end = std::min(bucket_count, begin + range_size);
            std::vector<std::uint32_t> next(end - begin);
            for (auto& block : by_range) {
                for (const Placed& placed : block[range]) ++next[placed.bucket - begin];
            }
            std::uint32_t start = first[range];
            for (std::size_t i = 0; i < next.size(); ++i) {
                starts_[begin + i] = start;
                start += std::exchange(next[i], start);
            }
            for (auto& block : by_range) {
                for (const Placed& placed : block[range]) {
                    items_[next[placed.bucket - begin]++] = placed.item;
                }
                block[range] = {};
            }
        });
    }

    bool empty() const { return items_.empty(); }
    std::span<const Item> bucket(std::size_t number) const {
        return {items_.data() + starts_[number], items_.data() + starts_[number + 1]};
    }
    /// All items, in the order of their buckets.
    std::span<Item> items() { return items_; }
    std::size_t bytes() const {
        return starts_.size() * sizeof(std::uint32_t) + items_.size() * sizeof(Item);
    }

private:
    static constexpr std::size_t ranges = 64;
    std::vector<std::uint32_t> starts_;  // one more than buckets
    std::vector<Item> items_;
};

}  // namespace lucerna::optics
