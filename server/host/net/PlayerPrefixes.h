// The number of players of each address prefix: for the limit per prefix, and because listeners reserve
// places for prefixes with players.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>

#include "shared/net/base/AddressPrefix.h"

namespace naiad {

/// A session counts from its welcome to its end, even without a stream. It counts for the prefix that its
/// player joined from, and for the player's present prefix if that differs. So a player cannot free a place
/// of a prefix by dropping or moving the stream.
///
/// Thread-safe; a call waits at most for another call.
class PlayerPrefixes {
 public:
  /// Records a join from `prefix`. Later calls for this session record a move to `prefix`.
  void record(std::uint64_t session, const AddressPrefix& prefix) {
    const std::lock_guard lock(m_mutex);
    const auto [found, joined] = m_sessions.try_emplace(session, Places{prefix, prefix});
    Places& places = found->second;
    if (!joined && places.present == prefix) return;
    if (!joined && places.present != places.joined) leave(places.present);
    places.present = prefix;
    if (joined || places.present != places.joined) ++m_counts[prefix];
  }
  /// Call when the session is over. Ignores unknown sessions.
  void forget(std::uint64_t session) {
    const std::lock_guard lock(m_mutex);
    const auto ended = m_sessions.extract(session);
    if (ended.empty()) return;
    const Places& places = ended.mapped();
    if (places.present != places.joined) leave(places.present);
    leave(places.joined);
  }

  /// Number of sessions that count for `prefix`.
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
  std::map<AddressPrefix, std::size_t> m_counts;  ///< the numbers are never zero
};

}  // namespace naiad
