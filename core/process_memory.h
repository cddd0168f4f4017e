// The memory of this process as the system counts it.
#pragma once

#include <cstdint>

namespace lucerna {

/// Most physical memory that the process held at once since the last restart_peak_memory(), where
/// the system can restart the count, else since the start of the process [byte]. Programs and
/// libraries that are shared count in full.
std::uint64_t peak_memory_bytes();

/// Hands freed memory back to the system and counts the peak anew from what is left.
void restart_peak_memory();

}  // namespace lucerna
