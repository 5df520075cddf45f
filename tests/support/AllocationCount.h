// Counts the memory allocations of this thread, including those by C libraries.
#pragma once

#include <cstdint>

namespace naiad::test {

/// False under sanitizers, which have their own allocator.
bool canCountAllocations();
std::uint64_t allocationsSoFar();

}  // namespace naiad::test
