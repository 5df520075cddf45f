#include "engine/world/DelayedFree.h"

#include <utility>

namespace df {

DelayedFree::~DelayedFree() {
  for (std::size_t i = 0; i < m_count; ++i) ::operator delete(m_blocks[i].p, m_blocks[i].align);
}

void DelayedFree::free(void* p, std::align_val_t align) noexcept {
  if (m_count < kKept) {
    m_blocks[m_count++] = {p, align};
    return;
  }
  const Block gone = std::exchange(m_blocks[m_oldest], {p, align});
  m_oldest = (m_oldest + 1) % kKept;
  ::operator delete(gone.p, gone.align);
}

}  // namespace df
