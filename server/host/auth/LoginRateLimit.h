// Limits failed logins per address prefix.
#pragma once

#include <chrono>
#include <cstddef>
#include <optional>

#include "shared/net/base/PrefixLruMap.h"

namespace naiad {

/// Counts the wrong tries of a time window. Not a token bucket, because a try counts only if it fails, and
/// messages promise players a time window. Until its result is known, a try counts as wrong; otherwise many
/// at once would evade the limit.
class LoginRateLimit {
 public:
  using Time = std::chrono::steady_clock::time_point;
  enum class Answer { kAllowed, kTooMany, kWait };

  LoginRateLimit(int wrong_per_window, std::chrono::seconds window, std::size_t prefixes)
      : wrong_per_window_(wrong_per_window), window_(window), table_(prefixes), cancelled_(prefixes) {}

  /// Begins a try. kAllowed: finishTry() or cancelTry() must follow. kTooMany: too many tries were wrong.
  /// kWait: too many would be wrong if those in progress are.
  Answer beginTry(const AddressPrefix& from, Time now) {
    PrefixFailures& entry = table_.use(from);
    if (!entry.since || now - *entry.since >= window_) {
      entry.since = now;
      entry.wrong = 0;
    }
    if (entry.wrong >= wrong_per_window_) return Answer::kTooMany;
    if (entry.wrong + entry.in_progress >= wrong_per_window_) return Answer::kWait;
    ++entry.in_progress;
    return Answer::kAllowed;
  }
  void finishTry(const AddressPrefix& from, bool right) {
    PrefixFailures* const entry = table_.find(from);
    if (entry == nullptr) return;  // evicted in the meantime
    if (entry->in_progress > 0) --entry->in_progress;
    if (!right) ++entry->wrong;
    if (entry->in_progress == 0 && entry->wrong == 0) table_.erase(from);
  }
  /// Ends a try dropped because other guesses had priority. It counts in cancelledTries(), not as wrong.
  void cancelTry(const AddressPrefix& from, Time now) {
    finishTry(from, true);
    CancelledTries& tries = cancelled_.use(from);
    if (!tries.since || now - *tries.since >= window_) tries = {now, 0};
    ++tries.count;
  }
  /// Number of wrong tries in the window of the last beginTry(); 0 for unknown prefixes.
  int wrong(const AddressPrefix& from) {
    const PrefixFailures* const entry = table_.find(from);
    return entry != nullptr ? entry->wrong : 0;
  }
  /// Number of cancelled tries in the present window; 0 for unknown prefixes.
  int cancelledTries(const AddressPrefix& from, Time now) {
    const CancelledTries* const tries = cancelled_.find(from);
    return tries != nullptr && now - *tries->since < window_ ? tries->count : 0;
  }
  std::size_t size() const { return table_.size(); }

 private:
  struct PrefixFailures {
    std::optional<Time> since;  ///< first try of the window
    int wrong = 0;
    int in_progress = 0;
  };

  struct CancelledTries {
    std::optional<Time> since;
    int count = 0;
  };

  int wrong_per_window_;
  std::chrono::seconds window_;
  PrefixLruMap<PrefixFailures> table_;
  PrefixLruMap<CancelledTries>
      cancelled_;  ///< a separate table, so that cancelled tries, which cost nothing, evict no wrong ones
};

}  // namespace naiad
