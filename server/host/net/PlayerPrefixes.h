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
  void note(std::uint64_t session, const AddressPrefix& prefix);
  /// The session is over. Harmless if it was never noted.
  void forget(std::uint64_t session);

  /// Sessions that count for `prefix`.
  std::size_t count(const AddressPrefix& prefix) const;

 private:
  struct Places {
    AddressPrefix joined;
    AddressPrefix present;
  };
  void leave(const AddressPrefix& prefix);

  mutable std::mutex m_mutex;
  std::map<std::uint64_t, Places> m_sessions;
  std::map<AddressPrefix, std::size_t> m_counts;  ///< none is zero
};

}  // namespace naiad
