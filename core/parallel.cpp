#include "core/parallel.h"

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <thread>

namespace lucerna {

int hardware_threads() {
    return static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
}

void for_each_block(std::size_t block_count, int threads,
                    const std::function<void(std::size_t)>& work) {
    if (threads <= 1 || block_count <= 1) {
        for (std::size_t block = 0; block < block_count; ++block) work(block);
        return;
    }
    // The library would not start more threads than the machine has cores unless told so.
    // Blocks are handed out one by one because their costs differ.
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(threads));
    tbb::task_arena arena(threads);
    arena.execute(
        [&] { tbb::parallel_for(std::size_t{0}, block_count, work, tbb::simple_partitioner()); });
}

}  // namespace lucerna
