// How many inputs a client may send: a leaky bucket that stays below what a server tolerates.
//
// A server applies 16 inputs a tick, keeps 64 waiting and ends the session of who sends more. A mouse at
// 1000 reports a second or a text pasted into the game must not cost the player the game.
#pragma once

#include <algorithm>
#include <chrono>

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
    const std::chrono::duration<double> passed = now - m_last;
    const std::chrono::duration<double> tick = m_tick;
    m_level = std::min(kBurst, m_level + kPerTick * std::max(passed / tick, 0.0));
    m_last = now;
    if (m_level < 1 && !urgent) return false;
    m_level = std::max(m_level - 1, -kBurst);
    return true;
  }

 private:
  std::chrono::microseconds m_tick{33333};
  double m_level = kBurst;
  Time m_last{};
};

}  // namespace naiad
