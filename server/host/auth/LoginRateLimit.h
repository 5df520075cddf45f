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
  Answer beginTry(const AddressPrefix& from, Time now) {
    Entry& entry = table_.use(from);
    if (!entry.since || now - *entry.since >= window_) {
      entry.since = now;
      entry.wrong = 0;
    }
    if (entry.wrong >= wrong_per_window_) return Answer::kTooMany;
    if (entry.wrong + entry.under_way >= wrong_per_window_) return Answer::kWait;
    ++entry.under_way;
    return Answer::kAllowed;
  }
  void finishTry(const AddressPrefix& from, bool right) {
    Entry* const entry = table_.find(from);
    if (entry == nullptr) return;  // evicted meanwhile
    if (entry->under_way > 0) --entry->under_way;
    if (!right) ++entry->wrong;
    if (entry->under_way == 0 && entry->wrong == 0) table_.erase(from);
  }
  /// The same if nothing was compared, since others came first.
  void giveUpTry(const AddressPrefix& from, Time now) {
    finishTry(from, true);
    GivenUp& tries = given_up_.use(from);
    if (!tries.since || now - *tries.since >= window_) tries = {now, 0};
    ++tries.count;
  }
  /// Tries of its window that were wrong; 0 for prefixes that are not remembered.
  int wrong(const AddressPrefix& from) {
    const Entry* const entry = table_.find(from);
    return entry != nullptr ? entry->wrong : 0;
  }
  /// The same for tries that were given up.
  int givenUp(const AddressPrefix& from, Time now) {
    const GivenUp* const tries = given_up_.find(from);
    return tries != nullptr && now - *tries->since < window_ ? tries->count : 0;
  }
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
