// Which transparent solids a point of a path lies in.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "optics/scene.h"

namespace lucerna::optics {

/// The set of solids that hold the current point. The medium that acts is the one of highest
/// priority (of equal ones the later object), or the surroundings with index 1 if there is none.
class MediumStack {
public:
    /// False if the solid is held already or the stack is full: the geometry contradicts itself.
    [[nodiscard]] bool enter(ObjectId solid);
    /// False if the solid was never entered.
    [[nodiscard]] bool leave(ObjectId solid);
    bool empty() const { return count_ == 0; }

    /// The solid whose medium acts here, or no_object for the surroundings.
    ObjectId acting(const SceneParts& parts) const {
        return empty() ? no_object : strongest(parts);
    }

private:
    ObjectId strongest(const SceneParts& parts) const;

    static constexpr unsigned capacity = 12;
    std::array<ObjectId, capacity> solids_;
    std::uint8_t count_ = 0;
};

}  // namespace lucerna::optics
