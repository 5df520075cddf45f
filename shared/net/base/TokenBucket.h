// A token bucket: limits a rate in the long run, and how much may come at once. Time is passed in.
#pragma once

#include <algorithm>
#include <chrono>

namespace naiad {

struct BucketRate {
  double per_second = 0;
  double burst = 0;  ///< tokens that a bucket holds, and begins with
};

/// Refilled by time alone. The rate is passed in, so that a table of buckets does not repeat it.
class TokenBucket {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// Takes one token, if there is one. `now` may be earlier than in the last call: nothing is added then.
  bool takeToken(const BucketRate& rate, Time now) {
    if (!hasToken(rate, now)) return false;
    tokens_ -= 1;
    return true;
  }
  /// Is there one to take?
  bool hasToken(const BucketRate& rate, Time now) {
    refill(rate, now);
    return tokens_ >= 1;
  }
  /// Takes one token even if there is none. The debt is at most a burst.
  void forceToken(const BucketRate& rate, Time now) {
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
