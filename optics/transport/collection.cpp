#include "optics/transport/collection.h"

#include "optics/transport/forward_trace.h"

namespace lucerna::optics {

Collection Collection::of(Method method, PlantedError planted) {
    constexpr std::uint8_t direct = mask(History::direct);
    constexpr std::uint8_t caustic = mask(History::caustic);
    constexpr std::uint8_t mapped = caustic | mask(History::indirect);
    Collection collection;
    switch (method) {
        case Method::automatic:
        case Method::combined:
            collection.first_gather = collection.sensor_gather = caustic;
            collection.second_direct = true;
            collection.second_deposit = mapped;
            break;
        case Method::forward:
            collection.first_gather = collection.sensor_gather = mapped;
            break;
        case Method::backward:
            collection.sensor_gather = caustic;
            collection.first_deposit = caustic;
            collection.second_deposit = direct | mapped;
            break;
        case Method::path:
            collection.whole_path = true;
            collection.emission_behind_specular = true;
            break;
    }
    if (planted == PlantedError::double_count) collection.emission_behind_specular = true;
    if (planted == PlantedError::gap) {
        collection.second_direct = false;
        collection.second_deposit &= mapped;
    }
    return collection;
}

Collection Collection::merged_where_seen() {
    return of(Method::forward, PlantedError::none);
}

}  // namespace lucerna::optics
