// Bounded queues of a bus: messages received (BusInbox) and messages to be sent (BusQueue).
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "host/fleet/Bus.h"
#include "shared/fleet/BusPayloads.h"

namespace naiad {

/// Received messages. Holds a limited number, and only the newest of each subject, so a server that sends
/// many messages cannot displace those of the others, and new subjects displace no known ones. Not
/// thread-safe.
class BusInbox {
 public:
  static constexpr std::size_t kMaxSubjects = 4096;  ///< messages of further subjects are ignored
  static constexpr std::size_t kMaxSubject = 128;    ///< maximum length of a subject, in bytes
  /// A subject is known until this many calls of popAll() in a row find no message of it.
  static constexpr int kMaxIdlePops = 64;

  void put(std::string_view subject, std::string_view payload) {
    ++m_received;
    const bool fits = subject.size() <= kMaxSubject && payload.size() <= kMaxBusPayload;
    const auto known = m_newest.find(subject);
    if (!fits || (m_newest.size() >= kMaxSubjects && known == m_newest.end())) {
      ++m_ignored;
      return;
    }
    Newest& newest = known != m_newest.end() ? known->second : m_newest[std::string(subject)];
    newest.payload = payload;
    newest.pops = 0;
  }
  /// Removes and returns the messages, sorted by subject.
  std::vector<BusMessage> popAll() {
    std::vector<BusMessage> taken;
    for (auto& [subject, newest] : m_newest) {
      if (++newest.pops == 1) taken.push_back({subject, std::move(newest.payload)});
    }
    std::erase_if(m_newest, [](const auto& known) { return known.second.pops > kMaxIdlePops; });
    return taken;
  }
  std::uint64_t received() const { return m_received; }
  std::uint64_t ignored() const { return m_ignored; }

 private:
  struct Newest {
    std::string payload;
    int pops = 0;  ///< calls of popAll() since the message was received
  };

  std::map<std::string, Newest, std::less<>> m_newest;  ///< key: subject
  std::uint64_t m_received = 0;
  std::uint64_t m_ignored = 0;
};

/// Messages to be sent, in one queue for reliable messages and one for others. When a queue is full, its
/// oldest message is dropped. Not thread-safe.
class BusQueue {
 public:
  /// Adds a message. If it may be lost (no id), it replaces an older one with its subject.
  void push(BusMessage message) {
    const bool is_reliable = !message.id.empty();
    std::deque<BusMessage>& queue = is_reliable ? m_reliable : m_best_effort;
    if (!is_reliable)
      std::erase_if(queue, [&](const BusMessage& other) { return other.subject == message.subject; });
    queue.push_back(std::move(message));
    if (queue.size() <= (is_reliable ? Bus::kMaxReliable : Bus::kMaxBestEffort)) return;
    queue.pop_front();
    ++m_dropped;
  }
  bool hasBestEffort() const { return !m_best_effort.empty(); }
  bool hasReliable() const { return !m_reliable.empty(); }
  bool isEmpty() const { return m_reliable.empty() && m_best_effort.empty(); }
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
