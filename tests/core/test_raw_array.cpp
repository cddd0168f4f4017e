#include "core/raw_array.h"

#include <catch2/catch.hpp>
#include <cstdint>
#include <utility>

#include "core/parallel.h"

using namespace lucerna;

namespace {

struct alignas(64) Item {
    std::size_t number;
};

}  // namespace

TEST_CASE("Items of a raw array are what threads made of them, in any order", "[unit]") {
    constexpr std::size_t count = 10000, blocks = 100;
    RawArray<Item> items(count);
    for_each_block(blocks, 3, [&](std::size_t block) {
        for (std::size_t i = count - 1 - block; i < count; i -= blocks) items.construct(i, {3 * i});
    });
    REQUIRE(items.size() == count);
    for (std::size_t i = 0; i < count; ++i) {
        REQUIRE(std::as_const(items)[i].number == 3 * i);
        REQUIRE(reinterpret_cast<std::uintptr_t>(items.data() + i) % alignof(Item) == 0);
    }
}

TEST_CASE("A raw array that was moved from is empty", "[unit]") {
    CHECK(RawArray<Item>().empty());
    RawArray<Item> from(2);
    from.construct(0, {5});
    from.construct(1, {7});
    RawArray<Item> to(std::move(from));
    CHECK(to[1].number == 7);
    from = RawArray<Item>(1);  // gives back nothing twice
    from.construct(0, {9});
    to = std::move(from);
    CHECK(from.empty());
    CHECK(to.size() == 1);
    CHECK(to[0].number == 9);
}
