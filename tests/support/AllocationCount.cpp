#include "AllocationCount.h"

#include <cstddef>

#ifndef __has_feature  // Clang has __has_feature() where GCC has macros
#define __has_feature(feature) 0
#endif
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__) && !__has_feature(address_sanitizer) && \
    !__has_feature(thread_sanitizer)
#define NAIAD_COUNT_ALLOCATIONS
#endif

namespace {
// Initialized by the loader because malloc() is called before constructors run.
constinit thread_local std::uint64_t allocations = 0;
}  // namespace

#ifdef NAIAD_COUNT_ALLOCATIONS
extern "C" {
// Other names of glibc's allocator. glibc allows replacing malloc and realloc together ("Replacing malloc" in
// its manual); free() need not be replaced.
void* __libc_malloc(std::size_t size);
void* __libc_realloc(void* memory, std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
// NOLINTEND(bugprone-reserved-identifier)

void* malloc(std::size_t size) {
  ++allocations;
  return __libc_malloc(size);
}
void* realloc(void* memory, std::size_t size) {
  ++allocations;
  return __libc_realloc(memory, size);
}
void* calloc(std::size_t count, std::size_t size) {
  ++allocations;
  return __libc_calloc(count, size);
}
}
#endif

namespace naiad::test {

bool canCountAllocations() {
#ifdef NAIAD_COUNT_ALLOCATIONS
  return true;
#else
  return false;
#endif
}

std::uint64_t allocationsSoFar() {
  return allocations;
}

}  // namespace naiad::test
