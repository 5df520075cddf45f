// Measures the round trip of datagrams with bytes added to packets that are sent anyway.
//
// A client's ping is a token. The server's next packet with two bytes to spare returns it with the time the
// server held it, so that the wait for a tick does not count. Callers pass the time.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <optional>
#include <utility>

namespace naiad {

/// The client's end. Only the newest ping is measured, so a new ping also replaces a lost one.
class LinkPing {
 public:
  using Time = std::chrono::steady_clock::time_point;
  using Millis = std::chrono::duration<double, std::milli>;

  struct Echo {
    std::uint8_t token = 0;
    std::uint8_t held_millis = 0;
  };

  /// Requests a ping in the next packet.
  void request() { m_requested = true; }
  bool isRequested() const { return m_requested; }
  /// Returns the ping's token for a packet that is sent now.
  std::uint8_t onSent(Time now) {
    m_requested = false;
    m_sent = now;
    return ++m_token;
  }
  /// Records an echo. Ignores echoes of older pings and duplicate echoes.
  void onEcho(const Echo& echo, Time now) {
    if (!m_sent || echo.token != m_token) return;
    const Millis held(echo.held_millis);
    m_round_trip = std::max(Millis(now - *std::exchange(m_sent, std::nullopt)) - held, Millis(0));
  }
  /// Returns and clears the round trip; nullopt if none was measured since the last call.
  std::optional<Millis> popRoundTrip() { return std::exchange(m_round_trip, std::nullopt); }

 private:
  bool m_requested = false;
  std::uint8_t m_token = 0;
  std::optional<Time> m_sent;  ///< time of the newest ping, until it is answered
  std::optional<Millis> m_round_trip;
};

/// The server's end.
class LinkEcho {
 public:
  using Time = LinkPing::Time;

  /// Pings held longer than this are not answered.
  static constexpr std::chrono::milliseconds kMaxHeld{255};

  void onPing(std::uint8_t token, Time now) { m_waiting = {token, now}; }
  /// Returns and clears the echo for a packet that is sent now; nullopt if no ping waits, or it was held for
  /// longer than kMaxHeld.
  std::optional<LinkPing::Echo> popEcho(Time now) {
    const auto waiting = std::exchange(m_waiting, std::nullopt);
    if (!waiting || now - waiting->second > kMaxHeld) return std::nullopt;
    const auto held = std::chrono::floor<std::chrono::milliseconds>(now - waiting->second);
    return LinkPing::Echo{waiting->first, static_cast<std::uint8_t>(held.count())};
  }

 private:
  std::optional<std::pair<std::uint8_t, Time>> m_waiting;
};

}  // namespace naiad
