// When the server heard from a client, and how much it heard since the last tick.
#pragma once

#include <chrono>
#include <utility>

#include "shared/net/base/IdleTimer.h"

namespace naiad {

class ClientActivity {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// An honest client that catches up after a stall sends fewer: every reply is bounded by what it got.
  static constexpr int kMessagesPerTick = 1024;

  explicit ClientActivity(Time now) : m_idle(now), m_frame_at(now) {}

  /// A message came. False if a client may not send so many between two ticks.
  bool countMessage() { return ++m_messages <= kMessagesPerTick; }
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
    m_messages = 0;
  }

  /// How long the client has been silent, to a tick (IdleTimer.h).
  auto silence(Time now) const { return m_idle.at(now); }
  /// When a frame came last.
  Time lastFrame() const { return m_frame_at; }

  /// A welcome was sent: the next frame proves that the client has read it.
  void awaitProof() { m_awaits_proof = true; }
  /// That frame has come. True once for each welcome.
  bool takeProof() { return std::exchange(m_proved, false); }

 private:
  bool m_spoke = false;  ///< since the last tick
  bool m_awaits_proof = false;
  bool m_proved = false;
  int m_messages = 0;  ///< since the last tick
  IdleTimer m_idle;
  Time m_frame_at;
};

}  // namespace naiad
