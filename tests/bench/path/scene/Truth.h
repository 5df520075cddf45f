// What the scene showed in its last 1024 ticks and when each of them began: written by the program that
// simulates it, read by the judge, through a shared file.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "../Monotonic.h"
#include "Picture.h"

namespace bench::path {

class Truth {
 public:
  struct Moment {
    std::uint32_t tick = 0;
    Nanoseconds start{};  ///< CLOCK_MONOTONIC, of the beginning of the tick
    Picture picture;
  };

  /// One writer. Tick 0 means nothing yet.
  void publish(std::uint32_t tick, Nanoseconds start, const Picture& picture) {
    m_moments[tick % kMoments] = {tick, start, picture};
    m_newest.store(tick, std::memory_order_release);
  }
  /// The newest tick, 0 before the first.
  std::uint32_t newest() const { return m_newest.load(std::memory_order_acquire); }
  /// Null for ticks that did not begin yet, and for those half a minute ago, which may be overwritten.
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
