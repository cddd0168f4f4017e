#include "core/parallel.h"

#include <atomic>
#include <catch2/catch.hpp>
#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

using namespace lucerna;

TEST_CASE("Each block is worked on once, by any number of threads", "[property]") {
    const int threads = GENERATE(1, 2, 3, 8);
    const std::size_t block_count = GENERATE(0u, 1u, 2u, 100u, 1000u);
    std::vector<int> visits(block_count, 0);
    for_each_block(block_count, threads, [&](std::size_t block) { ++visits[block]; });
    CHECK(visits == std::vector<int>(block_count, 1));
}

TEST_CASE("Work is spread over the threads that were asked for", "[unit]") {
    // Each of two blocks waits for the other: on one thread this would never end.
    std::atomic<int> arrived = 0;
    for_each_block(2, 2, [&](std::size_t) {
        ++arrived;
        while (arrived < 2) std::this_thread::yield();
    });
    CHECK(arrived == 2);
    CHECK(hardware_threads() >= 1);
}

TEST_CASE("One thread keeps to the caller's and to the order of blocks", "[unit]") {
    std::vector<std::size_t> order;
    std::set<std::thread::id> ids;
    for_each_block(5, 1, [&](std::size_t block) {
        order.push_back(block);
        ids.insert(std::this_thread::get_id());
    });
    CHECK(order == std::vector<std::size_t>{0, 1, 2, 3, 4});
    CHECK(ids == std::set<std::thread::id>{std::this_thread::get_id()});
}

TEST_CASE("An exception of a block reaches the caller", "[unit]") {
    const int threads = GENERATE(1, 4);
    const auto work = [](std::size_t block) {
        if (block == 7) throw std::runtime_error("block 7");
    };
    CHECK_THROWS_AS(for_each_block(100, threads, work), std::runtime_error);
}
