// The up to four parts in which a surface is measured, and which of them a path meets.
#pragma once

#include <array>
#include <cmath>
#include <optional>

#include "core/vector.h"

namespace lucerna::optics {

enum class Transport;

/// Side of a surface: the front is that of +z.
enum class Side { front, back };
inline Side side_of(const Vec3& direction) {
    return std::signbit(direction.z()) ? Side::back : Side::front;
}
inline Side other(Side side) {
    return side == Side::front ? Side::back : Side::front;
}

/// Parts by the side on which the light arrives; a part that is absent is black.
template <typename Part>
struct MeasuredParts {
    std::array<std::optional<Part>, 2> reflection;
    std::array<std::optional<Part>, 2> transmission;

    const Part* reflected(Side light) const { return pointer(reflection, light); }
    const Part* transmitted(Side light) const { return pointer(transmission, light); }

    /// The part that scatters light from `in` toward `out`, or nullptr.
    const Part* between(const Vec3& in, const Vec3& out) const {
        return side_of(in) == side_of(out) ? reflected(side_of(in)) : transmitted(side_of(in));
    }

private:
    static const Part* pointer(const std::array<std::optional<Part>, 2>& parts, Side light) {
        const auto& part = parts[static_cast<std::size_t>(light)];
        return part ? &*part : nullptr;
    }
};

}  // namespace lucerna::optics
