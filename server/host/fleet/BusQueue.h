// Bounded queues of a bus: messages received (BusInbox) and messages to be sent (BusQueue).
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "host/fleet/Bus.h"
#include "shared/fleet/BusPayloads.h"

namespace naiad {

/// Received messages. Holds a limited number, and only the newest of each subject, so a server that sends
/// many messages cannot displace those of the others. Not thread-safe.
class BusInbox {
 public:
  static constexpr std::size_t kMaxSubjects =
      4096;  ///< maximum number of subjects; messages of further ones are ignored
  static constexpr std::size_t kMaxSubject = 128;  ///< maximum length of a subject, in bytes

  void put(std::string subject, std::string payload) {
    ++m_received;
    const bool fits = subject.size() <= kMaxSubject && payload.size() <= kMaxBusPayload;
    if (!fits || (m_newest.size() >= kMaxSubjects && m_newest.count(subject) == 0)) {
      ++m_ignored;
      return;
    }
    m_newest.insert_or_assign(std::move(subject), std::move(payload));
  }
  /// Removes and returns the messages, sorted by subject.
  std::vector<BusMessage> popAll() {
    std::vector<BusMessage> taken;
    taken.reserve(m_newest.size());
    for (auto& [subject, payload] : m_newest) taken.push_back({subject, std::move(payload)});
    m_newest.clear();
    return taken;
  }
  std::uint64_t received() const { return m_received; }
  std::uint64_t ignored() const { return m_ignored; }

 private:
  std::map<std::string, std::string> m_newest;
  std::uint64_t m_received = 0;
  std::uint64_t m_ignored = 0;
};

/// Messages to be sent, in one queue for reliable messages and one for others. When a queue is full, its
/// oldest message is dropped. Not thread-safe.
class BusQueue {
 public:
  /// Adds a message. If it may be lost (no id), it replaces an older one with its subject.
  void push(BusMessage message) {
    if (!message.id.empty()) {
      m_reliable.push_back(std::move(message));
      if (m_reliable.size() <= Bus::kMaxReliable) return;
      m_reliable.pop_front();
      ++m_dropped;
      return;
    }
    std::erase_if(m_best_effort, [&](const BusMessage& other) { return other.subject == message.subject; });
    m_best_effort.push_back(std::move(message));
    if (m_best_effort.size() <= Bus::kMaxBestEffort) return;
    m_best_effort.pop_front();
    ++m_dropped;
  }
  bool hasBestEffort() const { return !m_best_effort.empty(); }
  bool hasReliable() const { return !m_reliable.empty(); }
  BusMessage popBestEffort() {
    BusMessage message = std::move(m_best_effort.front());
    m_best_effort.pop_front();
    return message;
  }
  /// Returns the oldest reliable message. It stays until ackReliable().
  const BusMessage& frontReliable() const { return m_reliable.front(); }
  /// Removes the oldest reliable message if it has this id; otherwise it was already dropped.
  void ackReliable(const std::string& id) {
    if (hasReliable() && m_reliable.front().id == id) m_reliable.pop_front();
  }
  std::uint64_t dropped() const { return m_dropped; }

 private:
  std::deque<BusMessage> m_best_effort;
  std::deque<BusMessage> m_reliable;
  std::uint64_t m_dropped = 0;
};

}  // namespace naiad
