// The sessions of a host's clients, by id.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "host/session/Session.h"

namespace naiad {

/// Not thread-safe. Callbacks run inside sessions, so sessions are destroyed in add() and sweep() alone: call
/// these from outside of any session's callback.
class SessionTable {
 public:
  using Clock = std::chrono::steady_clock;

  /// At most `max_sessions` at once. `on_remove` is called before a session is destroyed.
  SessionTable(std::size_t max_sessions, Counters& counters, std::function<void(Session&)> on_remove);

  /// Start a session on a new connection. If there are too many, the oldest that neither plays nor waits for
  /// an answer to its hello makes room; if there is none, the connection is closed.
  void add(std::unique_ptr<ReliableChannel> channel, Session::Events events, Clock::time_point now);
  /// Destroy the sessions that have ended.
  void sweep();

  /// Null if there is none.
  Session* find(std::uint64_t id) const;
  bool isEmpty() const { return m_sessions.empty(); }
  /// How many play, their connections broken or not.
  std::size_t playing() const;
  /// How many play on a connection.
  std::size_t connected() const;
  /// Ticks skipped for this player (Session::skippedTicks); 0 if there is none.
  std::uint64_t skippedTicks(std::uint32_t player) const;

  /// Call `visit(session)` for all, by id.
  template <class Visit>
  void forEach(Visit visit) const {
    for (const auto& session : m_sessions) visit(*session);
  }
  template <class Visit>
  void forEachPlaying(Visit visit) const {
    for (const auto& session : m_sessions) {
      if (session->state() == Session::State::kPlaying) visit(*session);
    }
  }

 private:
  bool makeRoom();

  std::size_t m_max_sessions;
  Counters& m_counters;
  std::function<void(Session&)> m_on_remove;
  std::uint64_t m_next_id = 1;
  std::vector<std::unique_ptr<Session>> m_sessions;  ///< by id
};

}  // namespace naiad
