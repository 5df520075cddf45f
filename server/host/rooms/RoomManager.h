// A host's rooms and their rounds (docs/rounds.md): one room for all players, one for each, or named rooms.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "host/rooms/HostContext.h"
#include "host/rooms/PlayerListBroadcaster.h"
#include "host/rooms/Room.h"
#include "host/rooms/ScoreBoard.h"
#include "host/rooms/SessionTable.h"
#include "host/session/Session.h"
#include "shared/replica/TruthFile.h"

namespace df {
class World;
}

namespace naiad {

/// Selects the player whose pictures are audited (ReplicaAudit.h): one player at a time, one second in ten.
///
/// An audit can only begin when a client gets the world from the beginning. So if a player has been audited
/// for ten seconds, the next player to join is audited instead, and at the start of a round the audit passes
/// to the next player by id. Thread: the host's.
class AuditScheduler {
 public:
  /// Pictures are compared in one of this many seconds.
  static constexpr std::uint32_t kPeriod = 10;

  /// Begins to audit. Before this call the other functions do nothing.
  void start(std::uint32_t ticks_per_second) { m_ticks_per_second = ticks_per_second; }
  /// May begin the session's audit. Call it when the session was welcomed, before anything else is sent.
  void onJoin(Session& session, std::uint32_t tick);
  /// May pass the audit on. Call it when a new round begins, before its first snapshots go to the players.
  void onRound(const Room& room, std::uint32_t tick);
  /// Ends the session's audit, if any. Call it before the session leaves its room or is destroyed.
  void forget(const Session& session);
  /// Returns the player whose picture is compared in this tick of the host, or 0.
  std::uint32_t auditedPlayer(std::uint32_t tick) const;

 private:
  void assign(Session& session, std::uint32_t tick);

  std::uint32_t m_ticks_per_second = 0;  ///< 0: no audit
  Session* m_p_session = nullptr;        ///< session that is audited; null: none
  std::uint32_t m_since = 0;             ///< tick in which its audit began
  std::uint32_t m_last = 0;              ///< player of the newest audit
};

/// Not thread-safe.
class RoomManager {
 public:
  /// `context` and `sessions` must outlive the RoomManager. `on_late_tick` is called when a tick ends after
  /// beginTicks() returned. Throws std::runtime_error if the truth file cannot be written.
  RoomManager(HostContext& context, const SessionTable& sessions, std::function<void()> on_late_tick);

  /// Uses new worlds of this kind instead of the one given to open(). Call it before open().
  void setWorlds(NewWorld new_world) { m_new_world = std::move(new_world); }
  /// Opens these named rooms instead of one room. All begin asleep, except the first and those that resume a
  /// round. Call it before open().
  void setNamed(std::vector<RoomConfig> plans) { m_plans = std::move(plans); }
  /// Sets the callback for a named room whose game cannot continue; its players must leave the room.
  void setOnRoomClosed(std::function<void(Room& room, const std::string& sentence)> on_closed) {
    m_on_closed = std::move(on_closed);
  }
  /// Sets the callback for a player whose game sends them to another named room.
  void setOnTransfer(std::function<void(Session& session, const std::string& room)> on_sent) {
    m_on_sent = std::move(on_sent);
  }
  /// Sets callbacks: `on_round` is called when the next round has begun in a room; `on_sessions`, when the
  /// replay of a killed server's round has ended or failed, with its players' sessions. Call before open().
  void setOnRound(std::function<void(Room&)> on_round,
                  std::function<void(Room&, const std::vector<PersistedSession>&)> on_sessions) {
    m_on_round = std::move(on_round);
    m_on_sessions = std::move(on_sessions);
  }
  /// If set, the game ends for all when the last connected player ends it, and no further round begins.
  void setEndsWithLast(bool ends) { m_ends_with_last = ends; }

  /// Sets the score tables of all worlds; they must outlive the RoomManager. Call it before open().
  void setScores(ScoreBoard& scores) { m_p_scores = &scores; }

  /// Begins to audit players' pictures (AuditScheduler).
  void startAudit(std::uint32_t ticks_per_second) { m_audit.start(ticks_per_second); }

  // Players.

  /// True if each player has a world of their own.
  bool isPrivate() const { return m_new_world && m_options.players == "private"; }
  /// Maximum number of worlds, including those that are ending, if each player has one.
  static std::size_t maxWorlds(const HostOptions& options);
  /// Returns the room for a new player. Returns null if a world cannot be started, with the reason in
  /// `problem`, or if worlds are being closed or the program was upgraded, with `problem` unchanged.
  Room* roomForNewPlayer(std::string& problem);
  // Named rooms.

  bool isNamed() const { return !m_plans.empty(); }
  /// Returns null if no room has this name.
  Room* findRoom(const std::string& name) const;
  /// The room in which players begin.
  Room& firstRoom() const { return *m_rooms.front(); }
  std::vector<std::string> roomNames() const;
  template <class Visit>
  void forEachRoom(Visit visit) const {
    for (const auto& room : m_rooms) visit(*room);
  }
  /// Gives a sleeping room a world. Fails like roomForNewPlayer(), returning false.
  bool wake(Room& room, std::string& problem);
  /// Removes a playing session from its room, and the player from the world there. add() adds it to another.
  void leaveRoom(const Session& session);

  /// Returns null for sessions that do not play.
  Room* roomOf(const Session& session) const;
  /// Returns null if no such player plays.
  Session* findPlayer(std::uint32_t player) const;
  /// Adds a session that was welcomed to this room.
  void add(Room& room, Session& session);
  /// Removes the player from the world, or ends the world if it is the player's own.
  void leave(const Session& session);
  /// Removes a session from its room, and ends its audit. Call it before the session is destroyed.
  void removeSession(const Session& session);
  std::size_t count() const { return m_rooms.size(); }
  /// Number of rooms that are not asleep.
  std::size_t countAwake() const;
  /// Progress in percent of a round that is being replayed (Round::recovering); nullopt if none is.
  std::optional<int> recovering() const;
  /// Number of published Objects in all rooms.
  std::size_t objects() const;
  /// Returns the players that are in their rooms' worlds, by id. Only scores come from the worlds, which may
  /// be untrusted programs. Valid until the next call.
  const std::vector<ListedPlayer>& players();

  // Ticks and rounds.

  /// If set, no further round begins after the current one.
  void setLastRound(bool last) { m_last_round = last; }
  /// Opens the room or the named rooms. With private worlds, roomForNewPlayer() opens the rooms.
  void open(df::World& world);
  using Time = RoomSleepState::Time;
  /// Time without players after which a world stands still, unless it ticks without players (runsEmpty()).
  static constexpr std::chrono::seconds kEmptyTime{60};
  /// Begins another round where a world has ended, stops worlds without players and resumes those that have
  /// players again. Call it once a tick.
  void checkWorlds(Time now = std::chrono::steady_clock::now());
  void beginTicks();
  /// True if all rooms stand still or sleep, and no world is in a tick, ending or being replayed.
  bool rest() const;
  /// True while any room's tick is running.
  bool isTicking() const;

  // The end.

  /// True if no round is being played and none will be.
  bool isOver() const;
  /// The reason for isOver(), for players; empty if the game ended in this process.
  const std::string& lastSentence() const { return m_last_sentence; }
  /// The last world's failure, like "crashed (SIGABRT)"; empty if it did not fail.
  const std::string& failure() const { return m_failure; }
  /// Returns, once, a log message if the server's program was upgraded on disk. A new world then has another
  /// build than this server, so no further world can begin; existing worlds continue.
  std::optional<std::string> popUpgradeMessage() { return std::exchange(m_upgrade_message, std::nullopt); }
  /// Allows new worlds again after an upgrade.
  void forgetUpgrade() { m_upgraded = false; }
  /// True if the game has ended the world given to open(), but may call GM.run() again.
  bool mayRestart() const { return !hasWorlds() && isOver() && !hasLastPlayer(); }
  /// Makes all players leave that world and join it again. Call this if mayRestart().
  void restart();
  /// Ends all worlds. A world process takes time to end: call again until isEmpty().
  void closeWorlds();
  bool isEmpty() const { return m_rooms.empty() && m_ending.empty(); }
  void clear() {
    m_rooms.clear();
    m_ending.clear();
  }

 private:
  std::uint32_t tickNumber() const { return static_cast<std::uint32_t>(m_counters.ticks); }
  bool hasLastPlayer() const { return m_ends_with_last && m_sessions.connectedCount() <= 1; }
  bool hasWorlds() const { return m_new_world || isNamed(); }
  Room& openRoom(std::unique_ptr<Round> round, bool first_only);
  void openNamed();
  std::unique_ptr<Round> newRound(const Room& room) const;
  bool runsEmpty(const Room& room) const;
  void checkPlayers(Time now);
  void checkSleep(Time now);
  void checkEnding();
  void putToSleep(Room& room);
  void publishRooms();
  void sendRoomList(Room& room) const;
  void forwardTransfers(Room& room);
  void closeRoom(Room& room, const std::string& sentence);
  const std::string& gameOf(const Room& room) const;
  void sendScores(Room& room) const;
  void setWorldCallbacks(Room& room);
  void endTick(Room& room);
  void publish(Room& room);
  void dismissLeavers(Room& room);
  void endRound(Room& room, const WorldEnd& end);
  void onUpgrade(const Room& room, const WorldEnd& end);
  void onFailover(const Room& room, const Failover& done);
  void endRecovery(Room& room, const std::vector<PersistedSession>& sessions);
  bool beginRound(Room& room);

  HostContext& m_context;
  const HostOptions& m_options;
  const SessionTable& m_sessions;
  Counters& m_counters;
  const LogLine& m_log;
  std::function<void()> m_on_late_tick;
  StageClock& m_stages;
  df::World* m_p_world = nullptr;  ///< world given to open()
  NewWorld m_new_world;            ///< makes new worlds; empty: see m_p_world and m_plans
  std::vector<RoomConfig> m_plans;
  std::vector<df::GameRoom> m_game_rooms;        ///< room list last passed to worlds, in the order of m_rooms
  std::vector<std::unique_ptr<Round>> m_ending;  ///< ending rounds of rooms that were put to sleep
  std::function<void(Room&, const std::string&)> m_on_closed;
  std::function<void(Session&, const std::string&)> m_on_sent;
  std::function<void(Room&)> m_on_round;
  std::function<void(Room&, const std::vector<PersistedSession>&)> m_on_sessions;
  std::vector<std::unique_ptr<Room>> m_rooms;
  std::vector<ListedPlayer> m_players;
  std::optional<TruthWriter> m_truth;
  AuditScheduler m_audit;
  ScoreBoard* m_p_scores = nullptr;  ///< null: scores are not saved
  bool m_ends_with_last = false;
  bool m_in_begin = false;
  bool m_over = false;  ///< no further round will begin
  bool m_closing = false;
  bool m_last_round = false;
  bool m_upgraded = false;  ///< new worlds have another build than this server
  std::optional<std::string> m_upgrade_message;
  std::string m_last_sentence;
  std::string m_failure;
};

}  // namespace naiad
