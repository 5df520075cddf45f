#include "shared/net/stream/ReliableFrames.h"

#include <algorithm>
#include <utility>

#include "shared/net/stream/Framing.h"
#include "shared/replica/Acks.h"

namespace naiad {

std::size_t ReliableFrames::Kept::size() const {
  return frame.size() + kFrameHeaderSize;
}

bool ReliableFrames::keep(std::string frame, bool replaces) {
  Kept kept{m_next, replaces, std::move(frame)};
  const auto before =
      replaces ? std::find_if(m_kept.begin(), m_kept.end(), [](const Kept& other) { return other.replaces; })
               : m_kept.end();
  const std::size_t freed = before != m_kept.end() ? before->size() : 0;
  if (m_bytes - freed + kept.size() > kMax) return false;
  m_bytes += kept.size() - freed;
  if (before != m_kept.end()) m_kept.erase(before);
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

void ReliableFrames::clear() {
  m_kept.clear();
  m_bytes = 0;
}

bool ReliableFramesHeard::take(std::uint32_t number) {
  if (number == 0) return true;
  if (m_newest != 0 && !isNewer(number, m_newest)) return false;
  m_newest = number;
  return true;
}

}  // namespace naiad
