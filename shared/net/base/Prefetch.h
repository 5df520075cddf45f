// Fetching memory before it is needed. A server goes through the state of thousands of clients in each tick,
// more than a cache holds, and always in the same order, so that it knows whose turn comes.
#pragma once

#include <cstddef>

namespace naiad {

/// Have `bytes` from `begin` on fetched, to be written. Changes nothing.
inline void prefetchMemory(const void* begin, std::size_t bytes) {
  constexpr std::size_t kLine = 64;
  const char* const first = static_cast<const char*>(begin);
  for (std::size_t at = 0; at < bytes; at += kLine) __builtin_prefetch(first + at, 1);
}

}  // namespace naiad
