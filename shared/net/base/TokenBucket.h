// A token bucket: limits the long-term rate and the size of a burst. Callers pass the time.
#pragma once

#include <algorithm>
#include <chrono>

namespace naiad {

struct BucketRate {
  double per_second = 0;
  double burst = 0;  ///< capacity in tokens, and the initial number
};

/// Refills with time. Each call passes the rate, so that a table of buckets need not store it.
class TokenBucket {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// Takes one token if there is one. `now` may be earlier than in the last call; then no tokens are added.
  bool tryConsume(const BucketRate& rate, Time now) {
    if (!canConsume(rate, now)) return false;
    tokens_ -= 1;
    return true;
  }
  /// True if tryConsume() would take a token now.
  bool canConsume(const BucketRate& rate, Time now) {
    refill(rate, now);
    return tokens_ >= 1;
  }
  /// Takes one token even from an empty bucket. The debt is at most `burst`.
  void forceConsume(const BucketRate& rate, Time now) {
    refill(rate, now);
    tokens_ = std::max(tokens_ - 1, -rate.burst);
  }

 private:
  void refill(const BucketRate& rate, Time now) {
    if (!begun_) {
      begun_ = true;
      tokens_ = rate.burst;
      last_ = now;
    } else if (now > last_) {
      const double elapsed = std::chrono::duration<double>(now - last_).count();
      tokens_ = std::min(rate.burst, tokens_ + elapsed * rate.per_second);
      last_ = now;
    }
  }

  double tokens_ = 0;
  Time last_{};
  bool begun_ = false;
};

}  // namespace naiad
