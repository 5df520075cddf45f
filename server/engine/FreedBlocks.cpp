#include "FreedBlocks.h"

#include <utility>

namespace df {

FreedBlocks::~FreedBlocks() {
  for (const Block& block : m_blocks) ::operator delete(block.p, block.align);
}

void FreedBlocks::free(void* p, std::align_val_t align) {
  if (m_blocks.size() < kKept) {
    m_blocks.push_back({p, align});
    return;
  }
  const Block gone = std::exchange(m_blocks[m_oldest], {p, align});
  m_oldest = (m_oldest + 1) % kKept;
  ::operator delete(gone.p, gone.align);
}

}  // namespace df
