// Points on patches found by place: a hashed grid with a cell size per patch.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/parallel.h"
#include "core/raw_array.h"
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

/// Tasks that put items into a table: enough for many threads, none for very few items.
inline std::size_t tasks_for(std::size_t items) {
    constexpr std::size_t most = 64, items_of_task = 1 << 10;
    return std::clamp<std::size_t>(items / items_of_task, 1, most);
}

/// Items sorted into buckets by counting. The order within a bucket is that of the tasks and
/// within them that of insertion, so that a sum over a bucket does not depend on threads.
template <typename Item>
class BucketTable {
public:
    /// @param bucket_count  a power of two, and several times the number of items.
    /// @param emit  emit(task, put) calls put(bucket, what) for what a task has, with bucket below
    ///              bucket_count; tasks may run concurrently.
    /// @param place  place(i, what) returns the item i that is made of it; concurrently as well.
    template <typename What, typename Emit, typename Place>
    void build(std::size_t bucket_count, std::size_t tasks, int threads, const Emit& emit,
               const Place& place) {
        // First by range of buckets, task by task; then within each range.
        struct Placed {
            std::uint32_t bucket;
            What what;
        };
        const std::size_t range_size = std::max<std::size_t>(1, bucket_count / ranges);
        std::vector<std::array<std::vector<Placed>, ranges>> by_range(tasks);
        for_each_block(tasks, threads, [&](std::size_t task) {
            // There are at least twice as many buckets as items, as a rule.
            for (auto& range : by_range[task]) range.reserve(bucket_count / (2 * tasks * ranges));
            emit(task, [&](std::size_t bucket, const What& what) {
                by_range[task][bucket / range_size].push_back(
                    {static_cast<std::uint32_t>(bucket), what});
            });
        });
        std::array<std::uint32_t, ranges + 1> first{};
        for (std::size_t range = 0; range < ranges; ++range) {
            first[range + 1] = first[range];
            for (const auto& task : by_range) {
                first[range + 1] += static_cast<std::uint32_t>(task[range].size());
            }
        }
        starts_ = RawArray<std::uint32_t>(bucket_count + 1);
        starts_.construct(bucket_count, first.back());
        items_ = RawArray<Item>(first.back());
        for_each_block(ranges, threads, [&](std::size_t range) {
            const std::size_t begin = std::min(bucket_count, range * range_size);
            const std::size_t end = std::min(bucket_count, begin + range_size);
            std::vector<std::uint32_t> next(end - begin);
            for (const auto& task : by_range) {
                for (const Placed& placed : task[range]) ++next[placed.bucket - begin];
            }
            std::uint32_t start = first[range];
            for (std::size_t i = 0; i < next.size(); ++i) {
                starts_.construct(begin + i, start);
                start += std::exchange(next[i], start);
            }
            for (auto& task : by_range) {
                for (const Placed& placed : task[range]) {
                    const std::uint32_t i = next[placed.bucket - begin]++;
                    items_.construct(i, place(i, placed.what));
                }
                task[range] = {};
            }
        });
    }

    bool empty() const { return items_.empty(); }
    std::span<const Item> bucket(std::size_t number) const {
        return {items_.data() + starts_[number], items_.data() + starts_[number + 1]};
    }
    /// Number of the first item of a bucket.
    std::size_t start(std::size_t bucket) const { return starts_[bucket]; }
    std::size_t bytes() const {
        return starts_.size() * sizeof(std::uint32_t) + items_.size() * sizeof(Item);
    }

private:
    static constexpr std::size_t ranges = 64;
    RawArray<std::uint32_t> starts_;  // one more than buckets
    RawArray<Item> items_;
};

}  // namespace lucerna::optics
