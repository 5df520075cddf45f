// The rooms of a host: one for all players, one for each, or those that have names, and the rounds that are
// played in them (docs/rounds.md).
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
#include "host/rooms/PlayerNews.h"
#include "host/rooms/Room.h"
#include "host/rooms/ScoreBoard.h"
#include "host/rooms/SessionTable.h"
#include "host/session/Session.h"
#include "shared/replica/TruthFile.h"

namespace df {
class World;
}

namespace naiad {

/// Whose pictures are audited (PictureAudit.h), and when: one player at a time, one second in ten.
///
/// An audit begins with a world that is sent from the beginning, so the turn goes to a player who joins once
/// the one before had ten seconds, and to the next one by id when a round begins.
/// Thread: the host's.
class AuditTurns {
 public:
  /// Ticks are compared in one second of so many.
  static constexpr std::uint32_t kPeriod = 10;

  /// Begin to audit. Before that nothing happens here.
  void start(std::uint32_t ticks_per_second) { m_ticks_per_second = ticks_per_second; }
  /// The session was welcomed, and has been sent nothing yet.
  void noteJoin(Session& session, std::uint32_t tick);
  /// All players of the room are about to be sent another world.
  void noteRound(const Room& room, std::uint32_t tick);
  /// The session is about to be destroyed.
  void forget(const Session& session);
  /// The player whose picture is wanted in this tick of the host; 0: none.
  std::uint32_t pictured(std::uint32_t tick) const;

 private:
  void give(Session& session, std::uint32_t tick);

  std::uint32_t m_ticks_per_second = 0;  ///< 0: there is no audit
  Session* m_p_session = nullptr;        ///< whose turn it is
  std::uint32_t m_since = 0;             ///< in this tick its turn began
  std::uint32_t m_last = 0;              ///< the player whose turn it was last
};

/// Not thread-safe.
class Rooms {
 public:
  /// `context` and `sessions` outlive the Rooms. `on_late_tick`: a tick has ended after beginTicks() had
  /// returned. Throws std::runtime_error for a truth file that cannot be written.
  Rooms(HostContext& context, const SessionTable& sessions, std::function<void()> on_late_tick);

  /// Play in such worlds, not in the one that open() is given. Before open().
  void setWorlds(NewWorld new_world) { m_new_world = std::move(new_world); }
  /// Have such rooms, instead of the one that open() makes. They begin asleep, but for the first. Before
  /// open().
  void setNamed(std::vector<RoomPlan> plans) { m_plans = std::move(plans); }
  /// The game of a room that has a name cannot go on: its players have to leave.
  void watchClosed(std::function<void(Room& room, const std::string& sentence)> on_closed) {
    m_on_closed = std::move(on_closed);
  }
  /// The game of a room that has a name sends this player of it to another one.
  void watchSent(std::function<void(Session& session, const std::string& room)> on_sent) {
    m_on_sent = std::move(on_sent);
  }
  /// A room's world is one that players were in: `on_round` a new one, after another; `on_sessions` that of a
  /// server that was killed, with the sessions that its players had. Before open().
  void watchRounds(std::function<void(Room&)> on_round,
                   std::function<void(Room&, const std::vector<KeptSession>&)> on_sessions) {
    m_on_round = std::move(on_round);
    m_on_sessions = std::move(on_sessions);
  }
  /// When the game is over for a player who is alone, it is over for all.
  void setEndsWithLast(bool ends) { m_ends_with_last = ends; }

  /// Tables of scores for all worlds; outlives the Rooms. Before open().
  void setScores(ScoreBoard& scores) { m_p_scores = &scores; }

  /// Audit pictures of players, one at a time.
  void startAudit(std::uint32_t ticks_per_second) { m_audit.start(ticks_per_second); }

  // Players.

  /// Each player has a world of their own.
  bool isPrivate() const { return m_new_world && m_options.players == "private"; }
  /// Worlds at once, where each player has one: those that are ending count.
  static std::size_t mostWorlds(const HostOptions& options);
  /// Null: there can be no world for another player, and `problem` says why; it is empty if the worlds are
  /// being closed.
  Room* roomForNewPlayer(std::string& problem);
  // Rooms that have names.

  bool isNamed() const { return !m_plans.empty(); }
  /// Null if there is none of this name.
  Room* findRoom(const std::string& name) const;
  /// Where players begin.
  Room& firstRoom() const { return *m_rooms.front(); }
  std::vector<std::string> roomNames() const;
  template <class Visit>
  void forEachRoom(Visit visit) const {
    for (const auto& room : m_rooms) visit(*room);
  }
  /// It has a world from now on. False: it cannot have one, and `problem` says why; it is empty if the worlds
  /// are being closed.
  bool wake(Room& room, std::string& problem);
  /// The session, which plays, leaves its room and the world in it; add() makes it one of another's.
  void leaveRoom(const Session& session);

  /// Null for sessions that do not play.
  Room* roomOf(const Session& session) const;
  /// Null if there is none.
  Session* findPlayer(std::uint32_t player) const;
  /// The session was welcomed to this room.
  void add(Room& room, Session& session);
  /// The player leaves; with them goes a world of their own.
  void leave(const Session& session);
  /// The session is about to be destroyed.
  void removeSession(const Session& session);
  std::size_t count() const { return m_rooms.size(); }
  /// Without those that sleep.
  std::size_t countAwake() const;
  /// Percent of a round that is being executed again (Round::recovering); nothing: none is.
  std::optional<int> recovering() const;
  /// Objects that are published, in all rooms.
  std::size_t objects() const;
  /// The players of all rooms whose worlds have them, by id. A world has the say in their scores alone: it
  /// may be a stranger's program. Valid until the next call.
  const std::vector<ListedPlayer>& players();

  // Ticks and rounds.

  /// No further round begins: what is played is the last one.
  void setLastRound(bool last) { m_last_round = last; }
  /// The first room; with worlds of their own each player opens one.
  void open(df::World& world);
  using Time = RoomSleep::Time;
  /// A world in which nobody has played for so long stands still, unless its game wants to go on.
  static constexpr std::chrono::seconds kEmptyTime{60};
  /// Begin another round where a world has ended; stop worlds without players, and let those with players go
  /// on. Once a tick.
  void checkWorlds(Time now = std::chrono::steady_clock::now());
  void beginTicks();
  /// All worlds stand still or sleep, and none is beginning or ending.
  bool rest() const;
  /// A room's tick has begun and not ended.
  bool isTicking() const;

  // The end.

  /// No round is played any more, and none will be.
  bool isOver() const;
  /// Why, for players; empty if the game ended in this process.
  const std::string& lastSentence() const { return m_last_sentence; }
  /// How the last world failed, like "crashed (SIGABRT)"; empty if it did not.
  const std::string& failure() const { return m_failure; }
  /// A new world is of another build than this server, whose program was upgraded: no further world can
  /// begin. Those that there are go on. In words for the log; nothing if it is not so, or was said before.
  std::optional<std::string> takeUpgrade() { return std::exchange(m_upgrade_news, std::nullopt); }
  /// Try again to begin worlds.
  void forgetUpgrade() { m_upgraded = false; }
  /// End all worlds. One in a process of its own takes time: call again until isEmpty().
  void closeWorlds();
  bool isEmpty() const { return m_rooms.empty() && m_ending.empty(); }
  void clear() {
    m_rooms.clear();
    m_ending.clear();
  }

 private:
  std::uint32_t tickNumber() const { return static_cast<std::uint32_t>(m_counters.ticks); }
  bool hasLastPlayer() const { return m_ends_with_last && m_sessions.connected() <= 1; }
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
  void passRooms(Room& room) const;
  void passSent(Room& room);
  void closeRoom(Room& room, const std::string& sentence);
  const std::string& gameOf(const Room& room) const;
  void passScores(Room& room) const;
  void watchWorld(Room& room);
  void endTick(Room& room);
  void publish(Room& room);
  void dismissLeavers(Room& room);
  void endRound(Room& room, const WorldEnd& end);
  void noteUpgrade(const Room& room, const WorldEnd& end);
  void noteTakeOver(const Room& room, const TakeOver& done);
  void endRecovery(Room& room, const std::vector<KeptSession>& sessions);
  void countEnd(WorldEnd::Why why);
  bool beginRound(Room& room);

  HostContext& m_context;
  const HostOptions& m_options;
  const SessionTable& m_sessions;
  Counters& m_counters;
  const LogLine& m_log;
  std::function<void()> m_on_late_tick;
  StageClock& m_stages;
  const df::World* m_p_world = nullptr;  ///< that open() was given
  NewWorld m_new_world;                  ///< empty: the world of this process, or m_plans
  std::vector<RoomPlan> m_plans;
  std::vector<df::GameRoom> m_game_rooms;        ///< what worlds were passed last, by room
  std::vector<std::unique_ptr<Round>> m_ending;  ///< of rooms that were put to sleep
  std::function<void(Room&, const std::string&)> m_on_closed;
  std::function<void(Session&, const std::string&)> m_on_sent;
  std::function<void(Room&)> m_on_round;
  std::function<void(Room&, const std::vector<KeptSession>&)> m_on_sessions;
  std::vector<std::unique_ptr<Room>> m_rooms;
  std::vector<ListedPlayer> m_players;
  std::optional<TruthWriter> m_truth;
  AuditTurns m_audit;
  ScoreBoard* m_p_scores = nullptr;  ///< null: nothing is kept
  bool m_ends_with_last = false;
  bool m_in_begin = false;
  bool m_over = false;  ///< there is no next round
  bool m_closing = false;
  bool m_last_round = false;
  bool m_upgraded = false;  ///< new worlds are of another build
  std::optional<std::string> m_upgrade_news;
  std::string m_last_sentence;
  std::string m_failure;
};

}  // namespace naiad
