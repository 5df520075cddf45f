// Delays the freeing of deleted Objects' memory.
//
// Some games written for the published engine call Objects that they have deleted. It mostly works there: the
// memory is not reused at once. So a world with `compat` keeps the memory for some more deletions: getters of
// a deleted Object return its old values or those now in its slot, and a handler called on it does nothing.
#pragma once

#include <array>
#include <cstddef>
#include <new>
#include <utility>

namespace df {

/// The memory blocks from Object's operator new in which no Object has been constructed yet. Object's
/// constructor searches for its address here, to learn whether it was made with `new`. There may be several,
/// as in `new A(new B)`.
class PendingBlocks {
 public:
  void push(const void* p, std::size_t size) {
    if (m_count < m_blocks.size()) m_blocks[m_count++] = {static_cast<const std::byte*>(p), size};
  }
  /// Removes the newest block that contains this address. Returns false if none does.
  bool claim(const void* p) {
    const auto* address = static_cast<const std::byte*>(p);
    for (std::size_t i = m_count; i-- > 0;) {
      if (address >= m_blocks[i].begin && address < m_blocks[i].begin + m_blocks[i].size) return erase(i);
    }
    return false;
  }
  /// Removes the block at `p`, if any, after a constructor threw before Object's constructor ran.
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
  /// Maximum number of freed blocks that are kept.
  static constexpr std::size_t kMaxKept = 4096;

  DelayedFree() = default;
  DelayedFree(const DelayedFree&) = delete;
  DelayedFree& operator=(const DelayedFree&) = delete;
  ~DelayedFree() {
    for (std::size_t i = 0; i < m_count; ++i) ::operator delete(m_blocks[i].p, m_blocks[i].align);
  }

  /// Keeps this block. If kMaxKept blocks are kept already, frees the oldest one.
  void free(void* p, std::align_val_t align) noexcept {
    if (m_count < kMaxKept) {
      m_blocks[m_count++] = {p, align};
      return;
    }
    const Block gone = std::exchange(m_blocks[m_oldest], {p, align});
    m_oldest = (m_oldest + 1) % kMaxKept;
    ::operator delete(gone.p, gone.align);
  }
  /// Returns the number of blocks kept.
  std::size_t size() const { return m_count; }

 private:
  struct Block {
    void* p = nullptr;
    std::align_val_t align{};
  };

  std::array<Block, kMaxKept> m_blocks;  // a ring, once it is full
  std::size_t m_count = 0;
  std::size_t m_oldest = 0;
};

}  // namespace df
