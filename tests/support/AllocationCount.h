// How often this thread has asked for memory, C libraries included.
#pragma once

#include <cstdint>

namespace naiad::test {

/// False under sanitizers, which have an allocator of their own.
bool canCountAllocations();
std::uint64_t allocationsSoFar();

}  // namespace naiad::test
