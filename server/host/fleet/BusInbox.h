// What came from a bus: bounded, and of each subject the newest, so that a server that says much crowds out
// no other.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "host/fleet/Bus.h"
#include "shared/fleet/BusPayloads.h"

namespace naiad {

/// Not thread-safe.
class BusInbox {
 public:
  static constexpr std::size_t kMaxSubjects = 4096;  ///< that wait to be taken
  static constexpr std::size_t kMaxSubject = 128;    ///< bytes

  void put(std::string subject, std::string payload) {
    ++m_received;
    const bool fits = subject.size() <= kMaxSubject && payload.size() <= kMaxBusPayload;
    if (!fits || (m_newest.size() >= kMaxSubjects && m_newest.count(subject) == 0)) {
      ++m_ignored;
      return;
    }
    m_newest.insert_or_assign(std::move(subject), std::move(payload));
  }
  /// In the order of their subjects.
  std::vector<BusMessage> takeAll() {
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

}  // namespace naiad
