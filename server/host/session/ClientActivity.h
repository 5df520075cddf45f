// When the server heard from a client, and how many messages it may still send.
#pragma once

#include <algorithm>
#include <chrono>
#include <utility>

#include "shared/net/base/LinkStats.h"

namespace naiad {

class ClientActivity {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// Messages at once. An honest client that catches up after a stall sends fewer: every reply is bounded by
  /// what it got.
  static constexpr int kMessagesAtOnce = 1024;
  /// Messages in the long run: the larger of the two. An honest client answers each snapshot, on two streams,
  /// and sends a few inputs a tick. This many cost about a hundredth of a core.
  static constexpr int kMessagesPerTick = 64;
  static constexpr int kMessagesPerSecond = 2000;

  explicit ClientActivity(Time now) : m_idle(now), m_frame_at(now), m_refilled(now) {}

  /// A message came. False if it is one too many.
  bool countMessage() { return --m_messages >= 0; }
  /// The message came by datagram.
  void noteDatagram() { m_spoke = true; }
  /// The message came on the first stream.
  void noteFrame(Time now) {
    m_spoke = true;
    m_frame_at = now;
    if (std::exchange(m_awaits_proof, false)) m_proved = true;
  }
  /// The client is back, on another stream.
  void noteReturn(Time now) { m_idle.heard(now); }
  /// Once a tick.
  void endTick(Time now) {
    if (m_spoke) m_idle.heard(now);
    m_idle.listen(now);
    m_spoke = false;
    refill(now);
  }

  /// How long the client has been silent, to a tick (IdleTimer).
  auto silence(Time now) const { return m_idle.at(now); }
  /// When a frame came last.
  Time lastFrame() const { return m_frame_at; }

  /// A welcome was sent: the next frame proves that the client has read it.
  void awaitProof() { m_awaits_proof = true; }
  /// That frame has come. True once for each welcome.
  bool takeProof() { return std::exchange(m_proved, false); }

 private:
  void refill(Time now) {
    constexpr std::chrono::milliseconds kEnough{1000};  // to refill all of it
    const auto passed = std::chrono::duration_cast<std::chrono::milliseconds>(
        std::min<Time::duration>(now - m_refilled, kEnough));
    m_refilled = now;
    const int more = static_cast<int>(passed.count()) * kMessagesPerSecond / 1000;
    m_messages = std::min(m_messages + std::max(more, kMessagesPerTick), kMessagesAtOnce);
  }

  bool m_spoke = false;  ///< since the last tick
  bool m_awaits_proof = false;
  bool m_proved = false;
  int m_messages = kMessagesAtOnce;  ///< that may come now
  IdleTimer m_idle;
  Time m_frame_at;
  Time m_refilled;
};

}  // namespace naiad
