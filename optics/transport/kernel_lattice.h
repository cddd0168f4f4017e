// Light in kernels around the points of square lattices, gathered once for all that is seen near
// them.
#pragma once

#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>

#include "core/raw_array.h"
#include "optics/transport/phase.h"

namespace lucerna::optics {

/// Light that arrives on one side of a surface, as a kernel sees it.
struct Arriving {
    Lanes density = Lanes::Zero();  ///< of flux, at the full radius [W/(m2 nm)]
    Lanes bias = Lanes::Zero();     ///< of it, as both kernels tell
    float photons = 0.0f;           ///< in the kernel
    float cut_off = 0.0f;           ///< share of the area of its disc
};

/// A table of points that any number of threads fill and read at once. What a point holds follows
/// from the point alone, so that it does not matter which thread comes first, nor whether there is
/// room for the point.
class KernelLattice {
public:
    explicit KernelLattice(std::size_t points);

    /// Which lattice: each side of a patch has its own.
    struct Side {
        std::uint32_t patch;
        bool above;
        bool hero_only;  ///< as paths of a single wavelength see it
    };

    /// Interpolated between the four points around (x, y), which are in spacings; nothing if one of
    /// them cannot stand for the side.
    /// @param gather  gather(i, j) of a point: Arriving, or nothing.
    template <typename Gather>
    std::optional<Arriving> between(const Side& side, double x, double y,
                                    const Gather& gather) const {
        const double i = std::floor(x), j = std::floor(y);
        const auto fits = [](double index) { return std::abs(index) < most_index; };
        if (!fits(i) || !fits(j) || side.patch > most_patch) return std::nullopt;
        const auto right = static_cast<float>(x - i), up = static_cast<float>(y - j);
        Arriving sum;
        for (const int k : {0, 1}) {
            for (const int l : {0, 1}) {
                const auto light =
                    at(side, static_cast<int>(i) + k, static_cast<int>(j) + l, gather);
                if (!light) return std::nullopt;
                const float weight = (k ? right : 1.0f - right) * (l ? up : 1.0f - up);
                sum.density += weight * light->density;
                sum.bias += weight * light->bias;
                sum.photons += weight * light->photons;
                sum.cut_off += weight * light->cut_off;
            }
        }
        return sum;
    }

    std::size_t bytes() const {
        return points_.size() * sizeof(Arriving) + tile_count() * sizeof(Tile);
    }

private:
    // What a key has room for.
    static constexpr int most_index = (1 << 19) - 8;
    static constexpr std::uint32_t most_patch = (1u << 22) - 1;
    static constexpr int edge = 4;                // of a tile, in points
    static constexpr std::size_t most_steps = 8;  // to where a tile stands
    enum State : std::uint8_t { empty, being_written, written, useless };

    // Neighbours lie next to each other, so that memory is touched where it is used.
    struct Tile {
        std::atomic<std::uint64_t> key;  // 0: free
        std::array<std::atomic<std::uint8_t>, std::size_t{edge} * edge> states;
    };
    static std::uint64_t key_of(const Side& side, int i, int j);
    std::size_t tile_count() const { return points_.size() / (std::size_t{edge} * edge); }
    /// Number of the tile, made if there is room; else tile_count().
    std::size_t find_tile(std::uint64_t key) const;

    template <typename Gather>
    std::optional<Arriving> at(const Side& side, int i, int j, const Gather& gather) const {
        const std::size_t tile = find_tile(key_of(side, i, j));
        if (tile == tile_count()) return gather(i, j);
        const auto in_tile = static_cast<std::size_t>((i & (edge - 1)) * edge + (j & (edge - 1)));
        std::atomic<std::uint8_t>& state = tiles_[tile].states[in_tile];
        Arriving& point = points_[tile * edge * edge + in_tile];
        std::uint8_t found = state.load(std::memory_order_acquire);
        if (found == written) return point;
        if (found == useless) return std::nullopt;
        const bool first = found == empty && state.compare_exchange_strong(found, being_written);
        std::optional<Arriving> light = gather(i, j);
        // If another thread is at it, to wait would take no less than to do it, too.
        if (first) {
            if (light) std::construct_at(&point, *light);
            state.store(light ? written : useless, std::memory_order_release);
        }
        return light;
    }

    mutable RawArray<Arriving> points_;
    std::unique_ptr<Tile[]> tiles_;
};

}  // namespace lucerna::optics
