// A harmless player, which plays at random and compares its pictures with the server's.
#pragma once

#include <asio/io_context.hpp>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "Relay.h"
#include "client/bot/BotScript.h"
#include "client/bot/TruthRecorder.h"
#include "client/session/Connection.h"

namespace bench::attack {

/// A server's address and access data.
struct Whereabouts {
  std::uint16_t port = 0;
  std::string fingerprint;
  std::string password;       ///< empty: none
  std::string known_servers;  ///< a file for pins
};

class HonestPlayer {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// If `relay` is given, the player connects through a relay, from another address.
  HonestPlayer(asio::io_context& context, const Whereabouts& server, const std::string& name,
               std::optional<Relay::Options> relay);

  void update(Time now);
  /// Returns the relay; null without one.
  Relay* relay() { return m_relay.get(); }
  bool isJoined() const { return m_connection->state() == naiad::Connection::State::kJoined; }
  /// True if the player is still in its first session.
  bool isInItsSession();
  /// True if the connection has ended, or has joined again as another player.
  bool isThrownOut();
  /// True if the connection has ended for good.
  bool isOver() const { return m_connection->isOver(); }
  /// Returns why the connection has ended or is retried, as a text for people.
  const std::string& message() const { return m_connection->message(); }
  /// Starts measuring pauses.
  void watchPauses(Time now);
  /// Returns the longest time without a new tick until now, in milliseconds.
  double pauseMillis(Time now) const;
  naiad::ClientSession* session() { return m_connection->session(); }

  /// Sends a goodbye. Run the event loop for a moment afterwards.
  void leave();
  naiad::TruthRecorder::Comparison compare(const std::string& truth_file) const {
    return m_recorder.compare(truth_file, m_player);
  }

 private:
  void observe(naiad::ClientSession& session);
  void play(Time now);

  std::unique_ptr<Relay> m_relay;
  std::unique_ptr<naiad::Connection> m_connection;
  naiad::TruthRecorder m_recorder;
  bool m_observed = false;
  std::uint32_t m_player = 0;  ///< 0: has not joined yet
  bool m_thrown_out = false;
  std::optional<naiad::RandomPlayer> m_fingers;
  Time m_next_tick{};
  Time m_news{};  ///< when the newest tick arrived
  std::uint32_t m_newest = 0;
  double m_pause_ms = 0;
};

}  // namespace bench::attack
