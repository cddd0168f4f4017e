#include "core/parallel.h"

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <memory>
#include <mutex>
#include <thread>

namespace lucerna {
namespace {

struct Workers {
    explicit Workers(int threads)
        : limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads)),
          arena(threads) {}

    // The library would not start more threads than the machine has cores unless told so.
    tbb::global_control limit;
    tbb::task_arena arena;
};

// The last ones are kept: to call threads together anew takes as long as a small piece of work.
std::shared_ptr<Workers> workers(int threads) {
    static std::mutex mutex;
    static auto& kept = *new std::pair<int, std::shared_ptr<Workers>>;  // outlives all callers
    const std::scoped_lock lock(mutex);
    if (kept.first != threads) {
        kept.second.reset();
        kept = {threads, std::make_shared<Workers>(threads)};
    }
    return kept.second;
}

}  // namespace

int hardware_threads() {
    return static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
}

void for_each_block(std::size_t block_count, int threads,
                    const std::function<void(std::size_t)>& work) {
    if (threads <= 1 || block_count <= 1) {
        for (std::size_t block = 0; block < block_count; ++block) work(block);
        return;
    }
    // Blocks are handed out one by one because their costs differ.
    workers(threads)->arena.execute(
        [&] { tbb::parallel_for(std::size_t{0}, block_count, work, tbb::simple_partitioner()); });
}

}  // namespace lucerna
