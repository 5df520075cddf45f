// A player of a fleet: asks the directory, is redirected to a server, and plays there.
#pragma once

#include <asio/io_context.hpp>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>

#include "client/bot/BotScript.h"
#include "client/session/Connection.h"

namespace bench {

class Bot {
 public:
  using Clock = std::chrono::steady_clock;
  using Time = Clock::time_point;

  Bot(asio::io_context& context, const naiad::ServerAddress& directory, const naiad::ServerTrust& trust,
      int number)
      : m_connection(context, directory, optionsOf(number), true, trust),
        m_keys(static_cast<std::uint64_t>(number), 80, 24) {
    m_connection.start();
  }

  void update(Time now) {
    m_connection.update(now);
    if (m_redirected_at == Time() && m_connection.isRedirected()) m_redirected_at = now;
    const bool playing = isPlaying();
    if (m_was_playing && !playing) {
      ++m_losses;
      m_lost = true;
    }
    if (!m_was_playing && playing) {
      if (!m_redirect && m_redirected_at != Time())
        m_redirect = std::chrono::duration_cast<std::chrono::milliseconds>(now - m_redirected_at);
      if (m_killed_at != Time() && m_lost) m_back_at = now;
    }
    m_was_playing = playing;
    if (!playing || now < m_next_key) return;
    m_next_key = now + kBetweenKeys;
    for (const naiad::BotAction& action : m_keys.tick()) {
      if (const auto* const p_key = std::get_if<naiad::KeyAction>(&action))
        m_connection.session()->sendKey(p_key->key, p_key->action, now);
    }
  }
  bool isPlaying() const { return m_connection.state() == naiad::Connection::State::kJoined; }
  bool isOver() const { return m_connection.isOver(); }
  const std::string& message() const { return m_connection.message(); }
  std::uint16_t port() const { return m_connection.address().port; }
  std::uint32_t player() { return m_connection.session()->welcome().player; }
  void leave() { m_connection.leave(); }

  /// Returns the time from the first redirect to the first picture; nullopt if there was no redirect.
  std::optional<std::chrono::milliseconds> redirectTime() const { return m_redirect; }

  /// Records that the bot's server is killed now. isBack() is true when the bot has lost its server and plays
  /// again.
  void noteKill(Time now) {
    m_killed_at = now;
    m_back_at = {};
    m_lost = false;
    m_before = player();
    m_port_before = port();
  }
  bool isBack() const { return m_back_at != Time(); }
  bool isSamePlayer() { return player() == m_before && port() == m_port_before; }
  std::chrono::milliseconds backTime() const {
    return std::chrono::duration_cast<std::chrono::milliseconds>(m_back_at - m_killed_at);
  }
  /// Returns how often the bot has lost its server.
  int losses() const { return m_losses; }

 private:
  static constexpr std::chrono::milliseconds kBetweenKeys{200};

  static naiad::SessionOptions optionsOf(int number) {
    naiad::SessionOptions options;
    options.name = "bot" + std::to_string(number);
    options.program = "naiad_fleet";
    options.columns = 80;
    options.rows = 24;
    return options;
  }

  naiad::Connection m_connection;
  naiad::RandomPlayer m_keys;
  Time m_next_key{};
  Time m_redirected_at{};
  std::optional<std::chrono::milliseconds> m_redirect;
  bool m_was_playing = false;
  int m_losses = 0;
  Time m_killed_at{};
  Time m_back_at{};
  bool m_lost = false;
  std::uint32_t m_before = 0;
  std::uint16_t m_port_before = 0;
};

}  // namespace bench
