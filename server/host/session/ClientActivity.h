// Tracks when the server last heard from a client, and how many messages the client may still send.
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
  /// replies are limited by what it received.
  static constexpr int kMessagesAtOnce = 1024;
  /// Sustained rate of messages: the larger of the two limits. An honest client acknowledges each snapshot,
  /// on two streams, and sends a few inputs a tick. Messages at this rate cost about 1 % of a core.
  static constexpr int kMessagesPerTick = 64;
  static constexpr int kMessagesPerSecond = 2000;

  explicit ClientActivity(Time now) : m_idle(now), m_frame_at(now), m_refilled(now) {}

  /// Counts a message. False if it is over the limit.
  bool countMessage() { return --m_messages >= 0; }
  /// Call for each message that came by datagram.
  void noteDatagram() { m_spoke = true; }
  /// Call for each message that came on the first stream.
  void noteFrame(Time now) {
    m_spoke = true;
    m_frame_at = now;
    if (std::exchange(m_awaits_proof, false)) m_proved = true;
  }
  /// Call when the client has reconnected on another stream.
  void noteReturn(Time now) { m_idle.heard(now); }
  /// Call once a tick: updates the silence and refills the message limit.
  void endTick(Time now) {
    if (m_spoke) m_idle.heard(now);
    m_idle.listen(now);
    m_spoke = false;
    refill(now);
  }

  /// How long the client has been silent, accurate to a tick (IdleTimer).
  auto silence(Time now) const { return m_idle.at(now); }
  /// When the newest frame came on the first stream.
  Time lastFrame() const { return m_frame_at; }

  /// Call when a welcome was sent: the next frame proves that the client has read it.
  void awaitProof() { m_awaits_proof = true; }
  /// True once after that frame.
  bool takeProof() { return std::exchange(m_proved, false); }

 private:
  void refill(Time now) {
    constexpr std::chrono::milliseconds kEnough{1000};  // refills all of it
    const auto passed = std::chrono::duration_cast<std::chrono::milliseconds>(
        std::min<Time::duration>(now - m_refilled, kEnough));
    m_refilled = now;
    const int more = static_cast<int>(passed.count()) * kMessagesPerSecond / 1000;
    m_messages = std::min(m_messages + std::max(more, kMessagesPerTick), kMessagesAtOnce);
  }

  bool m_spoke = false;  ///< a message came since the last tick
  bool m_awaits_proof = false;
  bool m_proved = false;
  int m_messages = kMessagesAtOnce;  ///< messages that may come now
  IdleTimer m_idle;
  Time m_frame_at;
  Time m_refilled;
};

}  // namespace naiad
