#include "optics/transport/medium_stack.h"

#include <algorithm>

namespace lucerna::optics {

bool MediumStack::enter(ObjectId solid) {
    const auto end = solids_.begin() + count_;
    if (count_ == capacity || std::find(solids_.begin(), end, solid) != end) return false;
    solids_[count_++] = solid;
    return true;
}

bool MediumStack::leave(ObjectId solid) {
    const auto end = solids_.begin() + count_;
    const auto it = std::find(solids_.begin(), end, solid);
    if (it == end) return false;
    std::copy(it + 1, end, it);
    --count_;
    return true;
}

ObjectId MediumStack::strongest(const SceneParts& parts) const {
    const auto rank = [&](ObjectId solid) {
        return std::pair(parts.media[*parts.objects[solid].interior].priority, solid);
    };
    ObjectId best = no_object;
    for (unsigned i = 0; i < count_; ++i) {
        if (best == no_object || rank(solids_[i]) > rank(best)) best = solids_[i];
    }
    return best;
}

}  // namespace lucerna::optics
