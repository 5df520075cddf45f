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

  /// A network's wrong tries are remembered for this long after the latest one.
  static constexpr std::chrono::hours kMemory{1};

  LoginRateLimit(int wrong_per_window, std::chrono::seconds window, std::size_t prefixes)
      : wrong_per_window_(wrong_per_window), window_(window), table_(prefixes), wrong_(prefixes) {}

  /// Begins a try. kAllowed: finishTry() must follow. kTooMany: too many tries were wrong. kWait: too many
  /// would be wrong if those in progress are.
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
  /// Ends a try that began at `now`. `right`: the password was right, or not compared.
  void finishTry(const AddressPrefix& from, bool right, Time now) {
    if (!right) {
      WrongTries& tries = wrong_.use(from.widest());
      tries = {wrong(from, now) + 1, now};
    }
    PrefixFailures* const entry = table_.find(from);
    if (entry == nullptr) return;  // evicted in the meantime
    if (entry->in_progress > 0) --entry->in_progress;
    if (!right) ++entry->wrong;
    if (entry->in_progress == 0 && entry->wrong == 0) table_.erase(from);
  }
  /// Number of remembered wrong tries of the network (AddressPrefix::widest()) of `from`.
  int wrong(const AddressPrefix& from, Time now) {
    const WrongTries* const tries = wrong_.find(from.widest());
    return tries != nullptr && now - tries->latest < kMemory ? tries->count : 0;
  }
  std::size_t size() const { return table_.size(); }

 private:
  struct PrefixFailures {
    std::optional<Time> since;  ///< time of the first try in the window; nullopt: no try yet
    int wrong = 0;
    int in_progress = 0;
  };

  struct WrongTries {
    int count = 0;
    Time latest{};
  };

  int wrong_per_window_;
  std::chrono::seconds window_;
  PrefixLruMap<PrefixFailures> table_;
  PrefixLruMap<WrongTries> wrong_;  ///< a separate table, so that tries that are not wrong evict none
};

}  // namespace naiad
