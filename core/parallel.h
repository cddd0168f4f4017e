// Work in blocks of fixed size, so that what a block computes does not depend on the threads.
#pragma once

#include <cstddef>
#include <functional>

namespace lucerna {

/// Number of hardware threads.
int hardware_threads();

/// Calls work(block) for block = 0 .. block_count - 1 on `threads` threads, in any order.
/// Each block must write to memory of its own. An exception of a block is thrown again here.
void for_each_block(std::size_t block_count, int threads,
                    const std::function<void(std::size_t)>& work);

}  // namespace lucerna
