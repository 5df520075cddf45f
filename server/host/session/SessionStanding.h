// What a host knows of a player beside the game: since when they play, and what they may do.
#pragma once

#include <chrono>
#include <cstdint>

namespace naiad {

/// Time is passed in.
class SessionStanding {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// The client was welcomed.
  void begin(Time now) { m_joined = m_acted = now; }
  /// A key, a click or a line of chat came.
  void noteAction(Time now) { m_acted = now; }
  /// The session goes on with another stream, which is a sign of life. An admin's rights end, since a resume
  /// token must not give them.
  void changeStream(Time now) {
    m_acted = now;
    m_admin = false;
    ++m_streams;
  }

  Time joined() const { return m_joined; }
  Time acted() const { return m_acted; }
  bool isAdmin() const { return m_admin; }
  void setAdmin() { m_admin = true; }
  bool isMuted() const { return m_muted; }
  void setMuted(bool muted) { m_muted = muted; }
  /// How many streams the session has had before the present one.
  std::uint32_t streams() const { return m_streams; }

 private:
  Time m_joined{};
  Time m_acted{};
  std::uint32_t m_streams = 0;
  bool m_admin = false;
  bool m_muted = false;
};

}  // namespace naiad
