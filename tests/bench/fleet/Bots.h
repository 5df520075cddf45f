// Players of a fleet: each asks the directory, is sent to a server, and plays there.
#pragma once

#include <asio/io_context.hpp>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "client/bot/BotScript.h"
#include "client/session/Connection.h"

namespace bench {

class Bot {
 public:
  using Clock = std::chrono::steady_clock;
  using Time = Clock::time_point;

  Bot(asio::io_context& context, const naiad::ServerAddress& directory, const naiad::ServerTrust& trust,
      int number);

  void update(Time now);
  bool isPlaying() const { return m_connection.state() == naiad::Connection::State::kJoined; }
  bool isOver() const { return m_connection.isOver(); }
  const std::string& sentence() const { return m_connection.sentence(); }
  std::uint16_t port() const { return m_connection.address().port; }
  std::uint32_t player() { return m_connection.session()->welcome().player; }
  void leave() { m_connection.leave(); }

  /// From the moment that it was first sent on to its first picture; nothing: it was not.
  std::optional<std::chrono::milliseconds> redirectTime() const { return m_redirect; }

  /// Its server has been killed: it is back once it has lost it and plays again.
  void noteKill(Time now);
  bool isBack() const { return m_back_at != Time(); }
  bool isSamePlayer() { return player() == m_before && port() == m_port_before; }
  std::chrono::milliseconds backTime() const {
    return std::chrono::duration_cast<std::chrono::milliseconds>(m_back_at - m_killed_at);
  }
  /// How often it has lost its server.
  int losses() const { return m_losses; }

 private:
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

class Bots {
 public:
  /// Numbered from `first` on.
  Bots(const std::string& link, const std::filesystem::path& known_servers, int first, int count);

  /// One turn of some milliseconds.
  void serve();
  /// From now on they come, so many at a time.
  void bringIn(int at_once) { m_at_once = static_cast<std::size_t>(at_once); }
  std::vector<std::unique_ptr<Bot>>& all() { return m_bots; }
  std::size_t playing() const;
  /// All have come, and play.
  bool havePlayed() const { return playing() == m_count; }
  /// Why one of them cannot join, or plays no more; empty: none.
  std::string problem() const;
  void leaveAll();

 private:
  asio::io_context m_context{1};
  naiad::ServerAddress m_directory;
  naiad::ServerTrust m_trust;
  int m_first;
  std::size_t m_count;
  std::size_t m_at_once = 0;
  std::vector<std::unique_ptr<Bot>> m_bots;
};

}  // namespace bench
