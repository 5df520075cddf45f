// The blocks of memory that Object's operator new has handed out and in which no Object has been constructed
// yet. The constructor finds itself in one of them, or was not made with `new`. There is more than one at a
// time in `new A(new B)`.
#pragma once

#include <array>
#include <cstddef>

namespace df {

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

}  // namespace df
