// Points on patches found by place: a hashed grid with a cell size per patch.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/parallel.h"
#include "core/raw_array.h"
#include "core/vector.h"

namespace lucerna::optics {

/// A number from 0 to 1 that hangs on a position alone, and is another one close by.
inline double scrambled(const Vec3& position) {
    // Mixing steps of MurmurHash3's finaliser.
    std::uint64_t bits = 0;
    for (int i = 0; i < 3; ++i) {
        bits ^= std::bit_cast<std::uint64_t>(position[i]);
        bits *= 0xFF51AFD7ED558CCDull;
        bits ^= bits >> 33;
    }
    return static_cast<double>(bits >> 11) * 0x1p-53;
}

/// The cells of the grid of one patch; several may share a hash.
class PatchCells {
public:
    PatchCells(std::uint32_t patch, double cell_m)
        : hash_of_patch_(patch * 0x9E3779B97F4A7C15ull), cell_m_(cell_m) {}

    /// Hash of the cell that holds a point.
    std::uint64_t hash_at(const Vec3& position) const {
        std::uint64_t h = hash_of_patch_;
        for (int axis = 0; axis < 3; ++axis) h = mixed(h, index(position[axis]));
        return h;
    }

    /// Calls use(hash) for the cells that an open ball meets.
    /// @param radius_m  at most that of cells.
    /// @param normal    nullptr, or that of a plane through the centre: then only for those that
    ///                  hold points of the ball up to off_plane_m from the plane, and few others.
    template <typename Use>
    void for_each_around(const Vec3& centre, double radius_m, const Vec3* normal,
                         double off_plane_m, const Use& use) const {
        // Along each axis: the cells, squares of their distances from the centre, and how far their
        // middles are from it along the normal.
        struct Along {
            std::int32_t first;
            int count = 0;
            std::array<double, 4> square_m2, off_plane_m;
        };
        std::array<Along, 3> along;
        double half_thickness_m = off_plane_m;
        for (int axis = 0; axis < 3; ++axis) {
            Along& of = along[static_cast<std::size_t>(axis)];
            const double n = normal ? (*normal)[axis] : 0.0;
            half_thickness_m += 0.5001 * cell_m_ * std::abs(n);
            of.first = index(centre[axis] - radius_m);
            const std::int32_t last = index(centre[axis] + radius_m);
            for (; of.first + of.count <= last && of.count < 4; ++of.count) {
                const double low_m = cell_m_ * (of.first + of.count - begin) - centre[axis];
                const auto i = static_cast<std::size_t>(of.count);
                of.square_m2[i] = square(std::max({low_m, -low_m - cell_m_, 0.0}));
                of.off_plane_m[i] = n * (low_m + 0.5 * cell_m_);
            }
        }
        const auto& [x, y, z] = along;
        const double square_m2 = (1.0 + 1e-9) * square(radius_m);
        for (std::size_t i = 0; i < static_cast<std::size_t>(x.count); ++i) {
            const std::uint64_t of_x = mixed(hash_of_patch_, x.first + static_cast<int>(i));
            for (std::size_t j = 0; j < static_cast<std::size_t>(y.count); ++j) {
                const double in_xy_m2 = x.square_m2[i] + y.square_m2[j];
                if (in_xy_m2 >= square_m2) continue;
                const double off_xy_m = x.off_plane_m[i] + y.off_plane_m[j];
                const std::uint64_t of_xy = mixed(of_x, y.first + static_cast<int>(j));
                for (std::size_t k = 0; k < static_cast<std::size_t>(z.count); ++k) {
                    if (in_xy_m2 + z.square_m2[k] >= square_m2) continue;
                    if (normal && std::abs(off_xy_m + z.off_plane_m[k]) > half_thickness_m) {
                        continue;
                    }
                    use(mixed(of_xy, z.first + static_cast<int>(k)));
                }
            }
        }
    }

private:
    // The grid begins off the origin: planes at 0 are common, and would lie between cells.
    static constexpr double begin = 0.37;

    std::int32_t index(double coordinate) const {
        return static_cast<std::int32_t>(std::floor(coordinate / cell_m_ + begin));
    }
    // Mixing steps of MurmurHash3's finaliser over the packed coordinates.
    static std::uint64_t mixed(std::uint64_t h, std::int32_t c) {
        h ^= static_cast<std::uint32_t>(c);
        h *= 0xFF51AFD7ED558CCDull;
        return h ^ (h >> 32);
    }

    std::uint64_t hash_of_patch_;
    double cell_m_;
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
