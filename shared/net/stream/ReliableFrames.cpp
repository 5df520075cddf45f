#include "shared/net/stream/ReliableFrames.h"

#include <utility>

#include "shared/net/stream/Framing.h"
#include "shared/replica/Acks.h"

namespace naiad {

std::size_t ReliableFrameSender::Unacknowledged::size() const {
  return frame.size() + kFrameHeaderSize;
}

bool ReliableFrameSender::add(std::string frame) {
  Unacknowledged kept{m_next, std::move(frame)};
  if (m_bytes + kept.size() > kMax) return false;
  m_bytes += kept.size();
  m_unacknowledged.push_back(std::move(kept));
  if (++m_next == 0) m_next = 1;
  return true;
}

void ReliableFrameSender::acknowledge(std::uint32_t number) {
  if (number == 0 || !isNewer(m_next, number)) return;
  while (!m_unacknowledged.empty() && !isNewer(m_unacknowledged.front().number, number)) {
    m_bytes -= m_unacknowledged.front().size();
    m_unacknowledged.pop_front();
  }
}

bool ReliableFrameReceiver::accept(std::uint32_t number) {
  if (number == 0) return true;
  if (m_newest != 0 && !isNewer(number, m_newest)) return false;
  m_newest = number;
  return true;
}

}  // namespace naiad
