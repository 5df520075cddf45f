// How many inputs a client may send: a token bucket that stays below what a server tolerates.
//
// A server applies 16 inputs a tick, keeps 64 waiting and ends the session of a client that sends more. A
// mouse at 1000 reports a second or a text pasted into the game must not cost the player the game.
#pragma once

#include <chrono>

#include "shared/net/base/TokenBucket.h"

namespace naiad {

class InputBudget {
 public:
  using Time = std::chrono::steady_clock::time_point;

  static constexpr double kBurst = 32;
  static constexpr double kPerTick = 12;

  void setTick(std::chrono::microseconds tick) { m_tick = tick; }

  /// May one more input go out at `now`? Counts it if so. An `urgent` one (a key release, which must not be
  /// lost or the key would stay down) always may.
  bool spend(Time now, bool urgent) {
    const BucketRate rate{.per_second = kPerTick / std::chrono::duration<double>(m_tick).count(),
                          .burst = kBurst};
    if (urgent) m_bucket.forceToken(rate, now);
    return urgent || m_bucket.takeToken(rate, now);
  }

 private:
  std::chrono::microseconds m_tick{33333};
  TokenBucket m_bucket;
};

}  // namespace naiad
