#include "core/random.h"

#include <Random123/philox.h>

namespace lucerna {

RandomStream::RandomStream(std::uint64_t seed, std::uint32_t phase, RandomPurpose purpose,
                           std::uint32_t path)
    : key_{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)},
      counter_{0, static_cast<std::uint32_t>(purpose), phase, path} {}

void RandomStream::refill() {
    const r123::Philox4x32::ctr_type counter = {
        {counter_[0], counter_[1], counter_[2], counter_[3]}};
    const r123::Philox4x32::key_type key = {{key_[0], key_[1]}};
    const auto block = r123::Philox4x32()(counter, key);
    for (unsigned i = 0; i < 4; ++i) buffer_[i] = block[i];
    ++counter_[0];
    next_ = 0;
}

}  // namespace lucerna
