// Which address prefixes have players, and how many: for the limit on each, and for the places that listeners
// set aside for prefixes with players.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>

#include "shared/net/base/AddressPrefix.h"

namespace naiad {

/// A session counts from its welcome to its end, its stream broken or not: for the prefix that its player
/// joined from, and for the one where they are now, if that is another one. So neither leaving a stream nor
/// moving it frees a place of a prefix.
///
/// Thread-safe; no call waits for more than another one.
class PlayerPrefixes {
 public:
  /// The first time the session's player joins from `prefix`; later they have moved there.
  void note(std::uint64_t session, const AddressPrefix& prefix) {
    const std::lock_guard lock(m_mutex);
    const auto [found, joined] = m_sessions.try_emplace(session, Places{prefix, prefix});
    Places& places = found->second;
    if (!joined && places.present == prefix) return;
    if (!joined && places.present != places.joined) leave(places.present);
    places.present = prefix;
    if (joined || places.present != places.joined) ++m_counts[prefix];
  }
  /// The session is over. Harmless if it was never noted.
  void forget(std::uint64_t session) {
    const std::lock_guard lock(m_mutex);
    const auto ended = m_sessions.extract(session);
    if (ended.empty()) return;
    const Places& places = ended.mapped();
    if (places.present != places.joined) leave(places.present);
    leave(places.joined);
  }

  /// Sessions that count for `prefix`.
  std::size_t count(const AddressPrefix& prefix) const {
    const std::lock_guard lock(m_mutex);
    const auto found = m_counts.find(prefix);
    return found != m_counts.end() ? found->second : 0;
  }

 private:
  struct Places {
    AddressPrefix joined;
    AddressPrefix present;
  };
  void leave(const AddressPrefix& prefix) {
    const auto found = m_counts.find(prefix);
    if (--found->second == 0) m_counts.erase(found);
  }

  mutable std::mutex m_mutex;
  std::map<std::uint64_t, Places> m_sessions;
  std::map<AddressPrefix, std::size_t> m_counts;  ///< none is zero
};

}  // namespace naiad
