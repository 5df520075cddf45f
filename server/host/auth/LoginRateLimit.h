// Limits failed logins per address prefix.
#pragma once

#include <chrono>
#include <cstddef>
#include <optional>

#include "shared/net/base/PerAddress.h"

namespace naiad {

/// Not a token bucket: only the outcome of a try says whether it counts, and a window is what the player is
/// promised. A try under way counts as wrong until it is known; else many at once would evade the limit.
class LoginRateLimit {
 public:
  using Time = std::chrono::steady_clock::time_point;
  enum class Answer { kAllowed, kTooMany, kWait };

  LoginRateLimit(int wrong_per_window, std::chrono::seconds window, std::size_t prefixes)
      : wrong_per_window_(wrong_per_window), window_(window), table_(prefixes), given_up_(prefixes) {}

  /// kAllowed: finishTry() must follow. kTooMany: too many wrong tries. kWait: there may be too many,
  /// counting those under way.
  Answer beginTry(const AddressPrefix& from, Time now);
  void finishTry(const AddressPrefix& from, bool right);
  /// The same if nothing was compared, since others came first.
  void giveUpTry(const AddressPrefix& from, Time now);
  /// Tries of its window that were wrong; 0 for prefixes that are not remembered.
  int wrong(const AddressPrefix& from);
  /// The same for tries that were given up.
  int givenUp(const AddressPrefix& from, Time now);
  std::size_t size() const { return table_.size(); }

 private:
  struct Entry {
    std::optional<Time> since;  ///< the first try of the window
    int wrong = 0;
    int under_way = 0;
  };

  struct GivenUp {
    std::optional<Time> since;
    int count = 0;
  };

  int wrong_per_window_;
  std::chrono::seconds window_;
  PerAddress<Entry> table_;
  PerAddress<GivenUp> given_up_;  ///< a table of its own: giving up is free, and must evict no wrong tries
};

}  // namespace naiad
