// The sessions of a host's clients, by id.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "host/session/Session.h"
#include "shared/net/base/AddressPrefix.h"

namespace naiad {

// Chat lines from the server to one player.

/// Sends a chat line from the server, cut to kMaxChatLength characters. Thread: the host's.
void sendServerLine(Session& session, const std::string& text);

/// Not thread-safe. Callbacks run inside sessions, so sessions are destroyed in add() and sweep() alone: call
/// these from outside of any session's callback.
class SessionTable {
 public:
  using Clock = std::chrono::steady_clock;

  /// At most `max_sessions` at once. `on_remove` is called before a session is destroyed.
  SessionTable(std::size_t max_sessions, Counters& counters, std::function<void(Session&)> on_remove);

  /// Start a session on a new connection. If there are too many, one that neither plays nor waits for an
  /// answer to its hello makes room: the oldest of the most crowded address or /64, in the most crowded /24
  /// or /48, this connection included. If there is none, the connection is closed.
  void add(std::unique_ptr<ReliableChannel> channel, Session::Events events, Clock::time_point now);
  /// A session without a stream, to be restored.
  Session& addDetached(Clock::time_point now);
  /// At most so many from now on; those that are there stay.
  void setMost(std::size_t max_sessions) { m_max_sessions = max_sessions; }
  /// Destroy the sessions that have ended.
  void sweep();

  /// Null if there is none.
  Session* find(std::uint64_t id) const;
  bool isEmpty() const { return m_places.empty(); }
  /// How many play, their connections broken or not.
  std::size_t playing() const;
  /// How many play on a connection.
  std::size_t connected() const;
  /// Ticks skipped for this player (Session::skippedTicks); 0 if there is none.
  std::uint64_t skippedTicks(std::uint32_t player) const;

  /// Call `visit(session)` for all, by id.
  template <class Visit>
  void forEach(Visit visit) const {
    for (const Place& place : m_places) visit(*place.session);
  }
  template <class Visit>
  void forEachPlaying(Visit visit) const {
    for (const Place& place : m_places) {
      if (place.session->state() == Session::State::kPlaying) visit(*place.session);
    }
  }

 private:
  struct Place {
    std::unique_ptr<Session> session;
    AddressPrefix prefix;  ///< that the connection came from
  };
  using Places = std::vector<Place>;

  bool makeRoom(const AddressPrefix& newcomer);
  Places::iterator mostCrowding(const AddressPrefix& newcomer);

  std::size_t m_max_sessions;
  Counters& m_counters;
  std::function<void(Session&)> m_on_remove;
  std::uint64_t m_next_id = 1;
  Places m_places;  ///< by id
};

}  // namespace naiad
