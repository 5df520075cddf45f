// Tracks when a client last sent something, and how many messages the client may still send.
#pragma once

#include <algorithm>
#include <chrono>
#include <utility>

#include "shared/net/base/LinkStats.h"

namespace naiad {

class ClientActivity {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// Maximum burst of messages. An honest client that catches up after a stall sends fewer, because its
  /// replies are limited by the messages that it received.
  static constexpr int kMaxMessageBurst = 1024;
  /// Sustained rate of messages: the larger of the two limits. An honest client acknowledges each snapshot,
  /// on two streams, and sends a few inputs a tick. Messages at this rate cost about 1 % of a core.
  static constexpr int kMessagesPerTick = 64;
  static constexpr int kMessagesPerSecond = 2000;

  explicit ClientActivity(Time now) : m_idle(now), m_frame_at(now), m_refilled(now) {}

  /// Counts a message. False if it is over the limit.
  bool countMessage() { return --m_messages >= 0; }
  /// Call for each message that arrived by datagram.
  void onDatagram() { m_has_received = true; }
  /// Call for each message that arrived on the first stream.
  void onFrame(Time now) {
    m_has_received = true;
    m_frame_at = now;
    if (std::exchange(m_expects_confirmation, false)) m_welcome_confirmed = true;
  }
  /// Call when the client has reconnected on another stream.
  void onReconnect(Time now) { m_idle.onActivity(now); }
  /// Call once a tick: updates the silence and refills the message limit.
  void endTick(Time now) {
    if (m_has_received) m_idle.onActivity(now);
    m_idle.poll(now);
    m_has_received = false;
    refill(now);
  }

  /// Returns how long the client has been silent, accurate to a tick (IdleTimer).
  auto silence(Time now) const { return m_idle.idleTime(now); }
  /// Returns the time at which the newest frame arrived on the first stream; before the first one, the start.
  Time lastFrame() const { return m_frame_at; }

  /// Call when a welcome was sent: the next frame proves that the client has read it.
  void expectConfirmation() { m_expects_confirmation = true; }
  /// True once after the frame that expectConfirmation() waits for.
  bool popWelcomeConfirmed() { return std::exchange(m_welcome_confirmed, false); }

 private:
  void refill(Time now) {
    constexpr std::chrono::milliseconds kEnough{1000};  // refills the whole limit
    const auto passed = std::chrono::duration_cast<std::chrono::milliseconds>(
        std::min<Time::duration>(now - m_refilled, kEnough));
    m_refilled = now;
    const int more = static_cast<int>(passed.count()) * kMessagesPerSecond / 1000;
    m_messages = std::min(m_messages + std::max(more, kMessagesPerTick), kMaxMessageBurst);
  }

  bool m_has_received = false;  ///< true if onDatagram() or onFrame() was called since the last tick
  bool m_expects_confirmation = false;
  bool m_welcome_confirmed = false;
  int m_messages = kMaxMessageBurst;  ///< number of messages that the client may send now
  IdleTimer m_idle;
  Time m_frame_at;
  Time m_refilled;
};

}  // namespace naiad
