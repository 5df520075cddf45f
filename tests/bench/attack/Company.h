// Players during an attack: three honest ones and a newcomer each second.
#pragma once

#include <algorithm>
#include <asio/io_context.hpp>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "Guest.h"
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

/// A harmless player, which plays at random and compares its pictures with the server's.
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

/// Each second, a new player joins from its own /24 and leaves. Measures how long these players wait.
class Newcomers {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// Time after which a newcomer gives up.
  static constexpr std::chrono::milliseconds kPatience{5000};

  Newcomers(asio::io_context& context, const Whereabouts& server) : m_context(context), m_server(server) {}

  /// Starts a newcomer each second from now on.
  void begin(Time now) { m_next = now; }
  /// Starts no more newcomers.
  void end() { m_next = Time::max(); }
  void update(Time now) {
    if (now >= m_next) {
      m_next = std::max(m_next + std::chrono::seconds(1), now);
      const std::string address = addressIn(kNetwork, kAddressesPerNetwork * m_count++);
      m_guests.push_back({.address = address, .since = now, .next_attempt = now, .guest = {}});
    }
    std::erase_if(m_guests, [&](Newcomer& newcomer) { return !serve(newcomer, now); });
  }
  /// True while newcomers try to join or leave.
  bool isBusy() const { return !m_guests.empty(); }

  int count() const { return m_count; }
  /// Returns the number of newcomers that were refused or disconnected, or gave up.
  int failed() const { return m_failed; }
  /// Returns the longest time from a newcomer's first byte to its picture; at least kPatience if one failed.
  double slowestMillis() const { return m_slowest_ms; }

 private:
  static constexpr int kNetwork = 90;
  static constexpr int kAddressesPerNetwork = 250;  // of addressIn()
  // Time after which a newcomer that the server asked to wait tries again, as long as dfclient's.
  static constexpr std::chrono::milliseconds kRetryDelay{250};
  static constexpr std::chrono::milliseconds kLeaveTime{500};  // time for the goodbye to arrive

  struct Newcomer {
    std::string address;
    Time since;
    Time next_attempt;  ///< valid while there is no guest
    bool joined = false;
    Time joined_at{};
    std::unique_ptr<Guest> guest;
  };
  // Returns false when the newcomer is finished.
  bool serve(Newcomer& newcomer, Time now) {
    const double waited = std::chrono::duration<double, std::milli>(now - newcomer.since).count();
    if (!newcomer.guest) {
      if (now < newcomer.next_attempt) return true;
      newcomer.guest =
          std::make_unique<Guest>(m_context, m_server.port, newcomer.address, "new", m_server.password);
    }
    Guest& guest = *newcomer.guest;
    guest.update(now);
    if (newcomer.joined) return !guest.isOver() && now - newcomer.joined_at < kLeaveTime;
    if (guest.hasPicture(now)) {
      m_slowest_ms = std::max(m_slowest_ms, waited);
      newcomer.joined = true;
      newcomer.joined_at = now;
      guest.session()->leave();
      return true;
    }
    const bool in_time = now - newcomer.since < kPatience;
    if (in_time && !guest.isOver()) return true;
    if (in_time && guest.state() == Guest::State::kRefusedForNow) {
      newcomer.guest.reset();
      newcomer.next_attempt = now + kRetryDelay;
      return true;
    }
    ++m_failed;
    m_slowest_ms =
        std::max(m_slowest_ms, std::max<double>(waited, std::chrono::milliseconds(kPatience).count()));
    return false;
  }

  asio::io_context& m_context;
  const Whereabouts& m_server;
  Time m_next = Time::max();
  std::vector<Newcomer> m_guests;
  int m_count = 0;
  int m_failed = 0;
  double m_slowest_ms = 0;
};

/// Results of the players.
struct Fate {
  std::uint64_t wrong_cells = 0;
  std::uint64_t compared_ticks = 0;
  int thrown_out = 0;  ///< honest players that lost their sessions
  int newcomers = 0;
  int newcomers_out = 0;   ///< newcomers that were refused, disconnected, or gave up
  double newcomer_ms = 0;  ///< longest wait of a newcomer, in ms
  double pause_ms = 0;     ///< longest pause between ticks for the player nearest to the server, in ms
  std::size_t crowd = 0;   ///< maximum number of players with the watched name in the player list
  std::uint64_t chat = 0;  ///< chat lines received by the player nearest to the server
};

class Company {
 public:
  using Clock = std::chrono::steady_clock;
  using Millis = std::chrono::milliseconds;

  /// Also records the largest number of players whose names begin with `watched`.
  Company(Whereabouts server, std::string watched)
      : m_server(std::move(server)),
        m_watched(std::move(watched)),
        m_plain(m_context, m_server, "plain"),
        m_far(m_context, m_server, "far", "127.1.0.2", Millis(100)),
        m_away(m_context, m_server, "away", "127.1.0.3"),
        m_newcomers(m_context, m_server) {}

  /// Lets all honest players join. Throws std::runtime_error if one cannot.
  void join() {
    for (const auto end = Clock::now() + std::chrono::seconds(30); !areHere(); serve()) {
      for (const HonestPlayer* p_player : m_honest) {
        if (p_player->isOver() || Clock::now() > end)
          throw std::runtime_error("an honest player cannot join: " + p_player->message());
      }
    }
  }
  /// Plays for `lead`, then with newcomers for `duration`, and up to ten seconds longer until all honest
  /// players have their streams and all newcomers have succeeded or failed. The player `away` is disconnected
  /// for the middle five sixths of the duration, for example 50 s of 60 s.
  void play(Millis lead, Millis duration) {
    for (const auto end = Clock::now() + lead; Clock::now() < end;) serve();
    const Clock::time_point begin = Clock::now();
    m_plain.watchPauses(begin);
    m_newcomers.begin(begin);
    bool cut = false;
    for (Clock::time_point now = begin; now < begin + duration; now = Clock::now()) {
      if (!cut && now >= begin + duration / 12) {
        cut = true;
        m_away.setOpen(false);
      }
      if (now >= begin + duration * 11 / 12) m_away.setOpen(true);
      serve();
    }
    m_away.setOpen(true);
    m_newcomers.end();
    const auto end = Clock::now() + std::chrono::seconds(10);
    while (Clock::now() < end && (m_newcomers.isBusy() || !areHere())) serve();
  }
  /// Lets all players leave. Returns the results, except those of compare().
  Fate leave() {
    Fate fate;
    fate.pause_ms = m_plain.pauseMillis(Clock::now());
    fate.newcomers = m_newcomers.count();
    fate.newcomers_out = m_newcomers.failed();
    fate.newcomer_ms = m_newcomers.slowestMillis();
    fate.crowd = m_crowd;
    if (m_plain.session() != nullptr) fate.chat = m_plain.session()->counters().chat_lines;
    for (HonestPlayer* p_player : m_honest) {
      fate.thrown_out += p_player->isInItsSession() ? 0 : 1;
      p_player->leave();
    }
    m_context.restart();
    m_context.run_for(Millis(500));
    return fate;
  }
  /// Compares the players' pictures with the server's. Call after the server has ended, when its truth file
  /// is complete.
  void compare(const std::string& truth_file, Fate& fate) const {
    for (const HonestPlayer* p_player : m_honest) {
      const naiad::TruthRecorder::Comparison compared = p_player->compare(truth_file);
      fate.wrong_cells += compared.wrong;
      fate.compared_ticks += compared.ticks;
    }
  }

 private:
  void serve() {
    m_context.restart();
    m_context.run_one_for(Millis(5));
    for (const auto enough = Clock::now() + Millis(20); Clock::now() < enough && m_context.poll_one() > 0;) {
    }
    const Clock::time_point now = Clock::now();
    for (HonestPlayer* p_player : m_honest) p_player->update(now);
    m_newcomers.update(now);
    if (m_watched.empty() || !m_plain.isInItsSession()) return;
    const auto count = std::ranges::count_if(m_plain.session()->players(), [this](const auto& player) {
      return player.name.starts_with(m_watched);
    });
    m_crowd = std::max(m_crowd, static_cast<std::size_t>(count));
  }
  bool areHere() {
    return std::ranges::all_of(m_honest, [](HonestPlayer* p_player) { return p_player->isInItsSession(); });
  }

  asio::io_context m_context{1};
  Whereabouts m_server;
  std::string m_watched;
  HonestPlayer m_plain;
  HonestPlayer m_far;
  HonestPlayer m_away;
  HonestPlayer* const m_honest[3] = {&m_plain, &m_far, &m_away};
  Newcomers m_newcomers;
  std::size_t m_crowd = 0;
};

}  // namespace bench::attack
