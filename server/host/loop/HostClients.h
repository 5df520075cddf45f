// A host's clients: their sessions, players, rooms, chat and the player list.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

#include "host/admission/Admission.h"
#include "host/admission/RoomTransfers.h"
#include "host/loop/HostEndpoint.h"
#include "host/rooms/HostContext.h"
#include "host/rooms/PlayerListBroadcaster.h"
#include "host/rooms/RoomManager.h"
#include "host/rooms/SessionTable.h"
#include "host/session/Counters.h"
#include "host/session/Session.h"
#include "shared/fleet/ServerInfo.h"
#include "shared/net/base/PrefixRateLimiter.h"
#include "shared/options/Duration.h"

namespace naiad {

/// Ends sessions of players that send no key, click or chat line for too long. Not thread-safe. The time is
/// Session::now().
class InactivityCheck {
 public:
  /// Players are warned this long before the limit or, if the limit is less than twice this, at half of it.
  /// They have that time after the warning, even if the server was paused before they were warned.
  static constexpr std::chrono::seconds kWarning{10};

  /// Call once a tick for each playing session. `limit` 0: no limit. Sessions without a connection are
  /// skipped, because the grace time limits them.
  void check(Session& session, std::chrono::seconds limit, Counters& counters,
             const std::function<void(Session&, const std::string& line)>& tell) {
    if (limit.count() <= 0 || session.state() != Session::State::kPlaying || session.isDetached()) return;
    const auto idle = session.now() - session.status().lastActivity();
    const auto warning = std::min<std::chrono::duration<double>>(kWarning, limit / 2.0);
    if (idle < limit - warning) {
      if (!m_warned.empty()) m_warned.erase(session.id());
      return;
    }
    const auto [warned, is_new] = m_warned.try_emplace(session.id(), session.now());
    if (is_new) return tell(session, "Press a key, or you will be disconnected.");
    if (session.now() - warned->second < warning) return;
    m_warned.erase(warned);
    ++counters.idle_kicks;
    session.sendGoodbye("Disconnected: no input for " + timeSpanText(limit) + ".");
  }
  /// Call when the session is over.
  void forget(const Session& session) { m_warned.erase(session.id()); }

 private:
  std::unordered_map<std::uint64_t, Session::Clock::time_point> m_warned;  ///< keys: session ids
};

/// Thread: the host's.
class HostClients {
 public:
  using Clock = std::chrono::steady_clock;

  /// `context` and `endpoint` must outlive this. `on_late_tick` is passed to RoomManager. Throws
  /// PasswordError, or std::runtime_error for a truth file that cannot be written.
  HostClients(HostContext& context, HostEndpoint& endpoint, std::function<void()> on_late_tick);

  SessionTable& sessions() { return m_sessions; }
  const SessionTable& sessions() const { return m_sessions; }
  RoomManager& rooms() { return m_rooms; }
  const RoomManager& rooms() const { return m_rooms; }
  Admission& admission() { return m_admission; }

  /// Plays in these worlds instead of the one of Host::run(): one after the other, or one per player
  /// (HostOptions::players). The world of Host::run() then only provides facts for welcomes. Call before
  /// run().
  void setWorlds(NewWorld new_world) { m_rooms.setWorlds(std::move(new_world)); }
  /// Plays in these rooms instead of one world; players start in the first room. Call before run().
  void setRooms(std::vector<RoomConfig> plans) { m_rooms.setNamed(std::move(plans)); }

  /// Sets the handler of chat commands: lines that begin with "/". They are never sent to other players.
  void setCommands(std::function<void(Session& session, const std::string& line)> serve_command) {
    m_serve_command = std::move(serve_command);
  }

  /// Returns the facts about this server that server lists show.
  ServerInfo facts() const;

  /// Call for each accepted connection.
  void add(std::unique_ptr<ReliableChannel> channel);
  /// Applies the player limit of the options in force. Logs it if too few files may be open for it.
  void applyCapacityLimits();
  /// Call once a tick, before worlds tick: serves deadlines, waiting hellos, and moves between rooms.
  void update(Clock::time_point now);
  /// Call once a tick, after worlds tick: sends the list of players of all rooms.
  void sendPlayers();
  /// Sends a line from the server to all players.
  void broadcast(const std::string& text);

 private:
  Session::Events sessionEvents();
  void handleChat(Session& session, const std::string& text);
  void sendChat(const Session& session, const std::string& text);
  void endSession(Session& session);

  HostContext& m_context;
  HostEndpoint& m_endpoint;
  SessionTable m_sessions;
  RoomManager m_rooms;
  PlayerListBroadcaster m_player_list;
  Admission m_admission;
  RoomTransfers m_room_transfers;
  PrefixRateLimiter m_chat;
  InactivityCheck m_inactivity;
  std::function<void(Session&, const std::string&)> m_serve_command;  ///< null without commands
};

}  // namespace naiad
