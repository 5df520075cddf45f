// The pictures and start times of the scene's last 1024 ticks. The program that simulates them writes this
// shared file, and the judge reads it.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

#include "../Monotonic.h"
#include "Picture.h"

namespace bench::path {

class Truth {
 public:
  struct Moment {
    std::uint32_t tick = 0;
    Nanoseconds start{};  ///< start of the tick by CLOCK_MONOTONIC
    Picture picture;
  };

  /// Publishes a tick, at least 1. There may be only one writer.
  void publish(std::uint32_t tick, Nanoseconds start, const Picture& picture) {
    m_moments[tick % kMoments] = {tick, start, picture};
    m_newest.store(tick, std::memory_order_release);
  }
  /// Returns the newest published tick; 0 before the first.
  std::uint32_t newest() const { return m_newest.load(std::memory_order_acquire); }
  /// Returns the moment of a tick; null for ticks that have not begun, and for ticks half a minute ago, which
  /// may be overwritten.
  const Moment* find(std::uint32_t tick) const {
    const std::uint32_t last = newest();
    if (tick == 0 || tick > last || last - tick > kMoments - 32) return nullptr;
    const Moment& moment = m_moments[tick % kMoments];
    return moment.tick == tick ? &moment : nullptr;
  }

 private:
  static constexpr std::uint32_t kMoments = 1024;
  static_assert(std::atomic<std::uint32_t>::is_always_lock_free);

  std::atomic<std::uint32_t> m_newest{0};
  std::array<Moment, kMoments> m_moments;
};

}  // namespace bench::path
