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
#include <utility>

namespace df {

/// The blocks of memory that Object's operator new has handed out and in which no Object has been constructed
/// yet. The constructor finds itself in one of them, or was not made with `new`. There is more than one at a
/// time in `new A(new B)`.
class PendingBlocks {
 public:
  void push(const void* p, std::size_t size) {
    if (m_count < m_blocks.size()) m_blocks[m_count++] = {static_cast<const std::byte*>(p), size};
  }
  /// Takes out the newest block that contains this address. False if there is none.
  bool claim(const void* p) {
    const auto* address = static_cast<const std::byte*>(p);
    for (std::size_t i = m_count; i-- > 0;) {
      if (address >= m_blocks[i].begin && address < m_blocks[i].begin + m_blocks[i].size) return erase(i);
    }
    return false;
  }
  /// Takes out the block that begins here: the constructor threw before it got to Object.
  void cancel(const void* p) {
    for (std::size_t i = m_count; i-- > 0;) {
      if (m_blocks[i].begin == p) erase(i);
    }
  }

 private:
  struct Block {
    const std::byte* begin;
    std::size_t size;
  };

  bool erase(std::size_t i) {
    for (--m_count; i < m_count; ++i) m_blocks[i] = m_blocks[i + 1];
    return true;
  }

  std::array<Block, 64> m_blocks;
  std::size_t m_count = 0;
};

class DelayedFree {
 public:
  /// Deletions for which a block is kept.
  static constexpr std::size_t kKept = 4096;

  DelayedFree() = default;
  DelayedFree(const DelayedFree&) = delete;
  DelayedFree& operator=(const DelayedFree&) = delete;
  ~DelayedFree() {
    for (std::size_t i = 0; i < m_count; ++i) ::operator delete(m_blocks[i].p, m_blocks[i].align);
  }

  /// Free this one later, and the one that has been waiting for longest now.
  void free(void* p, std::align_val_t align) noexcept {
    if (m_count < kKept) {
      m_blocks[m_count++] = {p, align};
      return;
    }
    const Block gone = std::exchange(m_blocks[m_oldest], {p, align});
    m_oldest = (m_oldest + 1) % kKept;
    ::operator delete(gone.p, gone.align);
  }
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
