// A host's clients: their sessions, who of them plays and in which room, what they say, and the list of
// players.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <unordered_set>
#include <vector>

#include "host/admission/Admission.h"
#include "host/admission/RoomMoves.h"
#include "host/loop/HostEndpoint.h"
#include "host/rooms/HostContext.h"
#include "host/rooms/PlayerNews.h"
#include "host/rooms/Rooms.h"
#include "host/rooms/SessionTable.h"
#include "host/session/Counters.h"
#include "host/session/Session.h"
#include "shared/admin/TimeSpan.h"
#include "shared/fleet/ServerFacts.h"
#include "shared/net/base/PrefixAllowance.h"

namespace naiad {

/// Ends sessions of players who do nothing: no key, no click, no line of chat.
/// Not thread-safe. Time is passed in.
class InactivityCheck {
 public:
  /// Players are warned so long before; of a shorter limit, at half of it.
  static constexpr std::chrono::seconds kWarning{10};

  /// Once a tick for each session that plays. `limit` 0: nobody is ended. One without a connection has its
  /// grace time instead.
  void check(Session& session, std::chrono::seconds limit, Counters& counters,
             const std::function<void(Session&, const std::string& line)>& tell) {
    if (limit.count() <= 0 || session.state() != Session::State::kPlaying || session.isDetached()) return;
    const auto idle = session.now() - session.standing().acted();
    const std::chrono::duration<double> warned_at =
        std::max<std::chrono::duration<double>>(limit - kWarning, limit / 2.0);
    if (idle < warned_at) {
      if (!m_warned.empty()) m_warned.erase(session.id());
    } else if (idle >= limit) {
      m_warned.erase(session.id());
      ++counters.inactive;
      session.goodbye("You did nothing for " + timeSpanText(limit) + ".");
    } else if (m_warned.insert(session.id()).second) {
      tell(session, "Press a key, or you leave the game in a moment.");
    }
  }
  /// The session is over.
  void forget(const Session& session) { m_warned.erase(session.id()); }

 private:
  std::unordered_set<std::uint64_t> m_warned;  ///< sessions
};

/// On the host's thread.
class HostClients {
 public:
  using Clock = std::chrono::steady_clock;

  /// `context` and `endpoint` outlive this. `on_late_tick`: of Rooms. Throws std::runtime_error for a truth
  /// file that cannot be written, and PasswordError.
  HostClients(HostContext& context, HostEndpoint& endpoint, std::function<void()> on_late_tick);

  SessionTable& sessions() { return m_sessions; }
  const SessionTable& sessions() const { return m_sessions; }
  Rooms& rooms() { return m_rooms; }
  const Rooms& rooms() const { return m_rooms; }
  Admission& admission() { return m_admission; }

  /// Play in such worlds instead of the one that Host::run() is given: one after the other, or one for each
  /// player (HostOptions::players). From the one it is given it takes only what welcomes say. New players get
  /// ids above `highest_player`, which the first world may have seen. Before run().
  void setWorlds(NewWorld new_world, std::uint32_t highest_player = 0);
  /// Have these rooms instead. Players begin in the first. Before run().
  void setRooms(std::vector<RoomPlan> plans);

  /// Commands in the chat, which begin with "/". They reach nobody but this, whatever becomes of them.
  void setCommands(std::function<void(Session& session, const std::string& line)> serve_command) {
    m_serve_command = std::move(serve_command);
  }

  /// What the server says of itself where players look for one.
  ServerFacts facts() const;

  /// A connection was accepted.
  void add(std::unique_ptr<ReliableChannel> channel);
  /// As many as may join by the options in force; a log line says so if too few files may be open for that.
  void makePlaces();
  /// Once a tick, before worlds tick: deadlines, hellos that wait, and moves between rooms.
  void update(Clock::time_point now);
  /// Once a tick, after them: the list of players, which has those of all rooms.
  void sendPlayers();
  /// A line from the server to all players.
  void say(const std::string& text);

 private:
  Session::Events sessionEvents();
  void takeChat(Session& session, const std::string& text);
  void sendChat(const Session& session, const std::string& text);
  void endSession(Session& session);

  HostContext& m_context;
  HostEndpoint& m_endpoint;
  SessionTable m_sessions;
  Rooms m_rooms;
  PlayerNews m_player_news;
  Admission m_admission;
  RoomMoves m_room_moves;
  PrefixAllowance m_chat;
  InactivityCheck m_inactivity;
  std::function<void(Session&, const std::string&)> m_serve_command;  ///< null: there are none
};

}  // namespace naiad
