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

/// Sends a chat line from the server, truncated to kMaxChatLength characters. Thread: the host's.
void sendServerLine(Session& session, const std::string& text);

/// Not thread-safe. Only add() and sweep() destroy sessions: do not call them in a session's callback.
class SessionTable {
 public:
  using Clock = std::chrono::steady_clock;

  /// add() keeps at most `max_sessions`. `on_remove` is called before add() or sweep() destroys a session.
  SessionTable(std::size_t max_sessions, Counters& counters, std::function<void(Session&)> on_remove);

  /// Starts a session on a new connection. If there are too many sessions, evicts one that neither plays nor
  /// waits for an answer to its hello: the oldest of the most crowded address or /64 in the most crowded /24
  /// or /48, counting the new connection. If no session can be evicted, closes the new connection.
  void add(std::unique_ptr<ReliableChannel> channel, Session::Events events, Clock::time_point now);
  /// Adds a session without a stream, to be restored.
  Session& addDetached(Clock::time_point now);
  /// Sets the maximum. Existing sessions stay.
  void setMaxSessions(std::size_t max_sessions) { m_max_sessions = max_sessions; }
  /// Idle time after which a player of a crowded address may lose their place.
  static constexpr std::chrono::minutes kIdleTime{1};
  /// Makes room for a player from `newcomer` when all `places` are taken by the playing sessions for which
  /// `counts` is true (null: all of them). Only sessions that have been idle for kIdleTime, and whose address
  /// or /64 has at least a quarter of the places, qualify; ends the one that has been idle longest. Returns
  /// false if none qualifies, or if a player from `newcomer` has a place.
  bool makePlace(const AddressPrefix& newcomer, std::size_t places, Clock::time_point now,
                 const std::function<bool(const Session&)>& counts = nullptr);
  /// Destroys the sessions that have ended.
  void sweep();

  /// Returns null if there is no session with this id.
  Session* find(std::uint64_t id) const;
  bool isEmpty() const { return m_slots.empty(); }
  /// Number of playing sessions, including those that lost their connection.
  std::size_t playingCount() const;
  /// Number of playing sessions that have a connection.
  std::size_t connectedCount() const;
  /// Number of ticks skipped for this player (Session::skippedTicks); 0 if there is no such player.
  std::uint64_t skippedTicks(std::uint32_t player) const;

  /// Calls `visit(session)` for all sessions, by id.
  template <class Visit>
  void forEach(Visit visit) const {
    for (const SessionSlot& slot : m_slots) visit(*slot.session);
  }
  template <class Visit>
  void forEachPlaying(Visit visit) const {
    for (const SessionSlot& slot : m_slots) {
      if (slot.session->state() == Session::State::kPlaying) visit(*slot.session);
    }
  }

 private:
  struct SessionSlot {
    std::unique_ptr<Session> session;
    AddressPrefix prefix;  ///< network of the client's address
  };
  using SessionSlots = std::vector<SessionSlot>;

  bool evictFor(const AddressPrefix& newcomer);
  SessionSlots::iterator evictionCandidate(const AddressPrefix& newcomer);

  std::size_t m_max_sessions;
  Counters& m_counters;
  std::function<void(Session&)> m_on_remove;
  std::uint64_t m_next_id = 1;
  SessionSlots m_slots;  ///< sorted by id
};

}  // namespace naiad
