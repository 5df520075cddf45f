// A harmless player, which plays at random and compares its pictures with the server's.
#pragma once

#include <algorithm>
#include <asio/io_context.hpp>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>

#include "client/bot/BotScript.h"
#include "client/bot/TruthRecorder.h"
#include "client/session/Connection.h"
#include "shared/replica/Acks.h"
#include "tests/loopback/StreamProxy.h"
#include "tests/loopback/Valve.h"

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

  /// With a `source`, the player connects from that address, `delay` away, and the connection can be cut.
  HonestPlayer(asio::io_context& context, const Whereabouts& server, const std::string& name,
               const std::string& source = {}, std::chrono::milliseconds delay = {}) {
    naiad::SessionOptions options;
    options.name = name;
    options.program = "naiad_attack";
    options.password = server.password;
    naiad::ServerTrust trust;
    trust.fingerprint = naiad::Fingerprint::parse(server.fingerprint);
    trust.known_servers = server.known_servers;
    std::uint16_t port = server.port;
    if (!source.empty()) {
      m_proxy = std::make_unique<naiad::test::StreamProxy>(context, server.port);
      m_proxy->setOwnAddress(source);
      m_proxy->setDelay(delay);
      m_valve->server_port = std::exchange(port, m_proxy->port());
      m_valve->delay = delay;
      options.open_socket = naiad::test::through(context, m_valve);
    }
    m_connection = std::make_unique<naiad::Connection>(context, naiad::ServerAddress{"127.0.0.1", port},
                                                       options, true, trust);
    m_connection->onSession([this](naiad::ClientSession& session) {
      if (!m_observed) observe(session);
    });
    m_connection->start();
  }

  void update(Time now) {
    m_valve->seen.clear();
    m_connection->update(now);
    if (m_player == 0 && isJoined()) {
      m_player = session()->welcome().player;
      m_newest = session()->clock().newestTick();
      m_fingers.emplace(m_player, session()->replica().viewWidth(), session()->replica().viewHeight());
      m_next_tick = now;
    }
    if (m_player == 0) return;
    m_thrown_out = m_thrown_out || m_connection->isOver() || session()->welcome().player != m_player;
    if (!m_thrown_out && isJoined()) play(now);
  }
  /// If not `open`, cuts the player's stream, refuses others, and loses all datagrams. Only with a `source`.
  void setOpen(bool open) {
    m_proxy->setOpen(open);
    m_valve->up = m_valve->down = open;
    if (!open) m_proxy->cut();
  }
  bool isJoined() const { return m_connection->state() == naiad::Connection::State::kJoined; }
  /// True if the player is still in its first session.
  bool isInItsSession() { return m_player != 0 && !m_thrown_out && isJoined() && !session()->isDetached(); }
  /// True if the connection has ended for good.
  bool isOver() const { return m_connection->isOver(); }
  /// Returns why the connection has ended or is retried, as a text for people.
  const std::string& message() const { return m_connection->message(); }
  /// Starts measuring pauses.
  void watchPauses(Time now) {
    m_news = now;
    m_pause_ms = 0;
  }
  /// Returns the longest time without a new tick until now, in milliseconds.
  double pauseMillis(Time now) const { return std::max(m_pause_ms, millisSinceNews(now)); }
  naiad::ClientSession* session() { return m_connection->session(); }

  /// Sends a goodbye. Run the event loop for a moment afterwards.
  void leave() {
    // If another session has replaced the first one, the replica of the first is gone.
    if (!m_thrown_out && session() != nullptr) m_recorder.finish(session()->replica());
    m_connection->leave();
  }
  naiad::TruthRecorder::Comparison compare(const std::string& truth_file) const {
    return m_recorder.compare(truth_file, m_player);
  }

 private:
  static constexpr std::chrono::milliseconds kNoRush{250};  // skips the keys missed in a longer pause

  // Skips ticks without a snapshot, because with lost datagrams their pictures are unknown.
  void observe(naiad::ClientSession& session) {
    m_observed = true;
    session.onBeforeSnapshot(
        [this, &session](std::uint32_t tick) { m_recorder.beforeSnapshot(session.replica(), tick); });
    session.onAfterSnapshot([this](const naiad::SnapshotHeader& header, const naiad::AckWindow& acks) {
      m_recorder.afterSnapshot(header, acks, true);
      if (!naiad::isNewer(header.tick, m_newest)) return;
      const Time now = std::chrono::steady_clock::now();
      if (m_news != Time{}) m_pause_ms = std::max(m_pause_ms, millisSinceNews(now));
      if (m_news != Time{}) m_news = now;
      m_newest = header.tick;
    });
  }
  void play(Time now) {
    if (now - m_next_tick > kNoRush) m_next_tick = now;
    while (now >= m_next_tick) {
      m_next_tick += session()->welcome().tick;
      for (const naiad::BotAction& action : m_fingers->tick()) {
        if (const auto* key = std::get_if<naiad::KeyAction>(&action))
          session()->sendKey(key->key, key->action, now);
        if (const auto* click = std::get_if<naiad::BotClick>(&action))
          session()->sendMouse(click->action, click->button, click->x, click->y, now);
      }
    }
  }
  double millisSinceNews(Time now) const {
    return std::chrono::duration<double, std::milli>(now - m_news).count();
  }

  std::unique_ptr<naiad::test::StreamProxy> m_proxy;
  std::shared_ptr<naiad::test::Valve> m_valve = std::make_shared<naiad::test::Valve>();
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
