#include "Heap.h"

#include <malloc.h>

#include <cstdlib>
#include <new>

namespace {

long s_allocations = 0;
long s_bytes = 0;

void* take(std::size_t size) {
  void* p = std::malloc(size > 0 ? size : 1);
  if (p == nullptr) throw std::bad_alloc();
  ++s_allocations;
  s_bytes += static_cast<long>(malloc_usable_size(p));
  return p;
}

void give(void* p) {
  if (p != nullptr) s_bytes -= static_cast<long>(malloc_usable_size(p));
  std::free(p);
}

}  // namespace

// The only way to see every allocation in the process: replace the operators.
void* operator new(std::size_t size) {
  return take(size);
}
void* operator new[](std::size_t size) {
  return take(size);
}
void operator delete(void* p) noexcept {
  give(p);
}
void operator delete[](void* p) noexcept {
  give(p);
}
void operator delete(void* p, std::size_t) noexcept {
  give(p);
}
void operator delete[](void* p, std::size_t) noexcept {
  give(p);
}

namespace bench {

long heapAllocations() {
  return s_allocations;
}

long heapBytes() {
  return s_bytes;
}

}  // namespace bench
