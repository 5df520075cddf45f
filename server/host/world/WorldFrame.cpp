#include "host/world/WorldFrame.h"

namespace naiad {

// Frames of a world are nearly as long as the one before, whose size is there already.
void FieldWriter::grow(std::size_t count) {
  const std::size_t used = size();
  m_out.resize(m_out.size() + m_out.size() / 8 + kFirstSize + count);
  m_p_next = m_out.data() + used;
  m_p_end = m_out.data() + m_out.size();
}

}  // namespace naiad
