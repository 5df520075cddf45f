#include "shared/net/stream/ReliableFrames.h"

#include <utility>

#include "shared/net/stream/Framing.h"
#include "shared/replica/Acks.h"

namespace naiad {

std::size_t ReliableFrames::Kept::size() const {
  return frame.size() + kFrameHeaderSize;
}

bool ReliableFrames::keep(std::string frame) {
  Kept kept{m_next, std::move(frame)};
  if (m_bytes + kept.size() > kMax) return false;
  m_bytes += kept.size();
  m_kept.push_back(std::move(kept));
  if (++m_next == 0) m_next = 1;
  return true;
}

void ReliableFrames::acknowledge(std::uint32_t number) {
  if (number == 0 || !isNewer(m_next, number)) return;
  while (!m_kept.empty() && !isNewer(m_kept.front().number, number)) {
    m_bytes -= m_kept.front().size();
    m_kept.pop_front();
  }
}

bool ReliableFramesHeard::take(std::uint32_t number) {
  if (number == 0) return true;
  if (m_newest != 0 && !isNewer(number, m_newest)) return false;
  m_newest = number;
  return true;
}

}  // namespace naiad
