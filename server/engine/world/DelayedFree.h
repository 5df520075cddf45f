// The memory of Objects that were deleted lately.
//
// Games written for the published engine go on asking Objects that they have deleted, which mostly works
// there for a while, because the memory is not used again yet. So a world with `compat` keeps it for some
// deletions more: getters of such an Object return what it was, or what its slot is now, and a handler called
// on it does nothing.
#pragma once

#include <array>
#include <cstddef>
#include <new>

namespace df {

class DelayedFree {
 public:
  /// Deletions for which a block is kept.
  static constexpr std::size_t kKept = 4096;

  DelayedFree() = default;
  DelayedFree(const DelayedFree&) = delete;
  DelayedFree& operator=(const DelayedFree&) = delete;
  ~DelayedFree();

  /// Free this one later, and the one that has been waiting for longest now.
  void free(void* p, std::align_val_t align) noexcept;
  /// How many are waiting.
  std::size_t size() const { return m_count; }

 private:
  struct Block {
    void* p = nullptr;
    std::align_val_t align{};
  };

  std::array<Block, kKept> m_blocks;  // a ring, once it is full
  std::size_t m_count = 0;
  std::size_t m_oldest = 0;
};

}  // namespace df
