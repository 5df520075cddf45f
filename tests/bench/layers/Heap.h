// What this program takes from the heap with operator new, the engine's library included.
#pragma once

namespace bench {

/// Allocations so far.
long heapAllocations();
/// Bytes that are taken now, as the allocator rounds them.
long heapBytes();

}  // namespace bench
