// Prefetches memory that will soon be needed.
#pragma once

#include <cstddef>

namespace naiad::physics {

inline constexpr std::size_t kCacheLine = 64;  // bytes
inline constexpr std::size_t kFetched = 8;     // number of elements to prefetch ahead

// Must be inlined, like all callers that only prefetch: GCC treats such functions as having no effect and
// removes calls of them.
[[gnu::always_inline]] inline void fetchLines(const void* p_first, std::size_t bytes) {
  const char* const p_byte = static_cast<const char*>(p_first);
  for (std::size_t i = 0; i < bytes; i += kCacheLine) __builtin_prefetch(p_byte + i);
  __builtin_prefetch(p_byte + bytes - 1);
}

}  // namespace naiad::physics
