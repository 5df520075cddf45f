// The round trip of datagrams, measured by bytes that ride on packets which are sent anyway.
//
// A client's ping is a token; the server returns it with its next packet, and how long it has held it, so
// that what it waited for a tick does not count. Pure: time is passed in.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <optional>
#include <utility>

namespace naiad {

/// The client's end. One ping at a time counts; one that is lost is forgotten with the next.
class LinkPing {
 public:
  using Time = std::chrono::steady_clock::time_point;
  using Millis = std::chrono::duration<double, std::milli>;

  struct Echo {
    std::uint8_t token = 0;
    std::uint8_t held_millis = 0;
  };

  /// Makes the next packet carry a ping.
  void ask() { m_asked = true; }
  bool isAsked() const { return m_asked; }
  /// The token for the packet that is sent now.
  std::uint8_t sent(Time now) {
    m_asked = false;
    m_sent = now;
    return ++m_token;
  }
  /// An echo came. One of another ping, or a second one, is ignored.
  void answered(const Echo& echo, Time now) {
    if (!m_sent || echo.token != m_token) return;
    const Millis held(echo.held_millis);
    m_round_trip = std::max(Millis(now - *std::exchange(m_sent, std::nullopt)) - held, Millis(0));
  }
  /// Nothing if none was measured since the last call.
  std::optional<Millis> takeRoundTrip() { return std::exchange(m_round_trip, std::nullopt); }

 private:
  bool m_asked = false;
  std::uint8_t m_token = 0;
  std::optional<Time> m_sent;  ///< the newest, until it is answered
  std::optional<Millis> m_round_trip;
};

/// The server's end.
class LinkEcho {
 public:
  using Time = LinkPing::Time;

  /// A ping held for longer is not answered.
  static constexpr std::chrono::milliseconds kMaxHeld{255};

  void notePing(std::uint8_t token, Time now) { m_waiting = {token, now}; }
  /// The echo for the packet that is sent now.
  std::optional<LinkPing::Echo> takeEcho(Time now) {
    const auto waiting = std::exchange(m_waiting, std::nullopt);
    if (!waiting || now - waiting->second > kMaxHeld) return std::nullopt;
    const auto held = std::chrono::floor<std::chrono::milliseconds>(now - waiting->second);
    return LinkPing::Echo{waiting->first, static_cast<std::uint8_t>(held.count())};
  }

 private:
  std::optional<std::pair<std::uint8_t, Time>> m_waiting;
};

}  // namespace naiad
