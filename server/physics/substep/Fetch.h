// Memory that is needed soon, fetched ahead.
#pragma once

#include <cstddef>

namespace naiad::physics {

inline constexpr std::size_t kCacheLine = 64;  // bytes
inline constexpr std::size_t kFetched = 8;     // elements ahead of the one that is worked on

// GCC takes a function that does nothing but fetch for one that does nothing, and leaves its calls out. So it
// must be inlined, and so must what calls it and does nothing else.
[[gnu::always_inline]] inline void fetchLines(const void* p_first, std::size_t bytes) {
  const char* const p_byte = static_cast<const char*>(p_first);
  for (std::size_t i = 0; i < bytes; i += kCacheLine) __builtin_prefetch(p_byte + i);
  __builtin_prefetch(p_byte + bytes - 1);
}

}  // namespace naiad::physics
