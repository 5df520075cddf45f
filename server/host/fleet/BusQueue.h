// What waits for a bus: bounded, the oldest goes first.
#pragma once

#include <cstdint>
#include <deque>
#include <utility>

#include "host/fleet/Bus.h"

namespace naiad {

/// Not thread-safe.
class BusQueue {
 public:
  /// Of messages that may be lost, one of a subject is enough: the newest.
  void push(BusMessage message) {
    if (!message.id.empty()) {
      m_kept.push_back(std::move(message));
      if (m_kept.size() <= Bus::kMaxKept) return;
      m_kept.pop_front();
      ++m_dropped;
      return;
    }
    std::erase_if(m_fleeting, [&](const BusMessage& other) { return other.subject == message.subject; });
    m_fleeting.push_back(std::move(message));
    if (m_fleeting.size() <= Bus::kMaxFleeting) return;
    m_fleeting.pop_front();
    ++m_dropped;
  }
  bool hasFleeting() const { return !m_fleeting.empty(); }
  bool hasKept() const { return !m_kept.empty(); }
  BusMessage takeFleeting() {
    BusMessage message = std::move(m_fleeting.front());
    m_fleeting.pop_front();
    return message;
  }
  /// The oldest; it stays until dropKept().
  const BusMessage& firstKept() const { return m_kept.front(); }
  /// It has arrived. Another may be the oldest meanwhile.
  void dropKept(const std::string& id) {
    if (hasKept() && m_kept.front().id == id) m_kept.pop_front();
  }
  std::uint64_t dropped() const { return m_dropped; }

 private:
  std::deque<BusMessage> m_fleeting;
  std::deque<BusMessage> m_kept;
  std::uint64_t m_dropped = 0;
};

}  // namespace naiad
