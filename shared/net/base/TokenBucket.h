// A leaky allowance: so many per second in the long run, so many at once.
#pragma once

#include <algorithm>
#include <chrono>

namespace naiad {

struct BucketRate {
  double per_second = 0;
  double burst = 0;  ///< what a bucket holds, and begins with
};

class TokenBucket {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// Take one, if there is one. `now` may be earlier than in the last call: then nothing is added.
  bool take(const BucketRate& rate, Time now) {
    if (!begun_) {
      begun_ = true;
      tokens_ = rate.burst;
      last_ = now;
    } else if (now > last_) {
      const double elapsed = std::chrono::duration<double>(now - last_).count();
      tokens_ = std::min(rate.burst, tokens_ + elapsed * rate.per_second);
      last_ = now;
    }
    if (tokens_ < 1) return false;
    tokens_ -= 1;
    return true;
  }

  /// When it was asked last.
  Time last() const { return last_; }

 private:
  double tokens_ = 0;
  Time last_{};
  bool begun_ = false;
};

}  // namespace naiad
