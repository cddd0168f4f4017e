#include <catch2/catch.hpp>

#include "core/process_memory.h"

using namespace lucerna;

TEST_CASE("The peak of memory holds what is in use, also after a restart", "[process_memory]") {
    constexpr std::size_t size_bytes = 32 << 20;
    const std::vector<char> block(size_bytes, 1);
    CHECK(peak_memory_bytes() > size_bytes);
    restart_peak_memory();
    CHECK(peak_memory_bytes() > size_bytes);
    CHECK(block[size_bytes / 2] == 1);
}
