// A round: a world, and all its inputs, which the round's owner adds here.
//
// Inputs of players wait in the next turn. When its tick begins, the turn is encoded once. The journal, if
// there is one, stores these bytes before the world gets them, and the tick's result afterwards.
//
// With a RoundRecovery the world first gets the turns of a killed server's round, as fast as it answers, and
// is then ready. Another world takes over in a similar way from one that crashed or hangs, without the keys
// and clicks of that tick: a copy that is a few seconds old, or a new world that replays the round.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "host/journal/Dfr.h"
#include "host/journal/RoundHistory.h"
#include "host/world/TurnRecord.h"
#include "host/world/WorldPort.h"

namespace naiad {

class Journal;
class JournalWriter;
class DeterminismCheck;
class RoundRecovery;
class WorldProcess;

/// Names a round in the file of scores.
struct RoundName {
  std::string id;    ///< unique, 32 hexadecimal digits
  std::string file;  ///< path of its recording below the folder of --journal; empty: not recorded
};

/// Report of a world that took over from one that crashed or hung.
struct Failover {
  bool by_checkpoint = false;  ///< a copy took over; false: a world that replayed the whole round
  std::uint32_t ticks = 0;     ///< number of ticks that the new world replayed
};

class Round {
 public:
  using Clock = std::chrono::steady_clock;

  /// If this many inputs wait for a tick, further keys and clicks are dropped; other inputs are not.
  static constexpr std::size_t kMaxInputs = 16'384;

  /// Ticks between two recorded hashes of the state and between two pictures, and the tick of the first
  /// picture. A picture takes about 500 bytes of the file, a hash 8.
  static constexpr std::uint32_t kHashTicks = 30;
  static constexpr std::uint32_t kPictureTicks = 900;
  static constexpr std::uint32_t kFirstPicture = 300;

  /// A crash or hang less than this many ticks after the previous one ends the round.
  static constexpr std::uint32_t kSameFailureTicks = 30;

  /// If the world that takes over ends before it began, another one starts within this time after the
  /// failure: all processes may have been killed at once.
  static constexpr std::chrono::seconds kRestartTime{1};

  /// Maximum number of scores kept from replayed turns; older ones are in the server's file.
  static constexpr std::size_t kMaxScores = 4096;

  /// The journal and the callbacks of a round.
  struct JournalBinding {
    std::shared_ptr<JournalWriter> writer = nullptr;
    std::shared_ptr<Journal> journal = nullptr;  ///< null: not recorded
    /// Called when the world begins its first tick or a replay; returns further facts. Empty: none.
    std::function<DfrFacts()> late_facts = {};
    /// Called when the journal has stopped, with the reason; the game continues.
    std::function<void(const std::string& problem)> on_problem = {};
    std::unique_ptr<DeterminismCheck> check;  ///< checks whether the game is repeatable; null: unchecked
    std::unique_ptr<RoundRecovery> recovery;  ///< null: a new round
    /// Called when a recovery's world has begun; returns why it is not the recorded world, or "" if it is.
    std::function<std::string()> find_difference = {};
    /// Called at the end of a recovery. `ticks`: the number of recorded ticks that the world has replayed.
    /// `problem`: why the recovery failed; empty: it has succeeded.
    std::function<void(std::uint32_t ticks, const std::string& problem)> on_recovered = {};
    std::string recording = {};    ///< path of the file below the folder of --journal
    std::string history = {};      ///< records of the round to recover
    std::uint32_t first_tick = 0;  ///< the host's number of the round's first tick; 0: unknown
    /// Starts another world of the round, if its world is a process; throws std::system_error. Empty: the
    /// round ends with its world.
    std::function<std::unique_ptr<WorldProcess>()> new_world = {};
    /// Called when the world has crashed or hung in this tick. `goes_on`: true if another is to take over.
    std::function<void(const WorldEnd& end, std::uint32_t tick, bool goes_on)> on_failure = {};
    /// Called when another world has taken over, with the time that it took.
    std::function<void(const Failover& done, std::chrono::milliseconds time)> on_failover = {};
    /// Called with sentences for the log about copies of the world.
    std::function<void(const std::string& sentence)> on_copies = {};
  };

  /// `highest_player`: the highest player id that the world has used; 0: none.
  explicit Round(std::unique_ptr<WorldPort> world, std::uint32_t highest_player = 0);
  Round(std::unique_ptr<WorldPort> world, JournalBinding book);
  /// A round that has not ended is recorded as stopped.
  ~Round();

  /// Sets the callback for the end of every tick, called from tick() or later from the host's event loop.
  void setOnTick(std::function<void()> on_tick) { m_on_tick = std::move(on_tick); }
  /// Returns the round's name. If the round is not recorded, setId() must set its id first.
  const RoundName& name() const { return m_name; }
  void setId(std::string id) { m_name.id = std::move(id); }

  // Input, in the order of arrival. It takes effect in the tick nextTick().

  /// Adds an input to the next turn. Drops keys and clicks beyond kMaxInputs.
  void addInput(df::InputQueue::Input input);
  /// Returns the highest player id in the round, with the turns to be replayed; 0 without players. A world
  /// uses an id only once.
  std::uint32_t highestPlayer() const { return m_highest_player; }
  /// Tells the world that the next turn has only this player's input; 0: all players'. Drops no input.
  void setInputPlayer(std::uint32_t player) { m_turn.input_player = player; }
  /// Ends the game: at once if its world is in this process, else at the end of the next tick.
  void endGame();

  // Ticks.

  /// True if a tick may begin.
  bool isReady() const { return !m_binding.recovery && m_world->isReady(); }
  /// Begins a tick. `watched`: view() will be read; after an unwatched tick it has all Objects as changed.
  /// `truth`: renderPlayer() will be called, too, for all players or only for `rendered_player`.
  void tick(bool watched, bool truth, std::uint32_t rendered_player = 0);
  /// Returns the number of the next tick to begin, as view() counts ticks.
  std::uint32_t nextTick() const { return m_failed_world ? m_failed_world->next_tick : m_world->nextTick(); }
  /// Returns the changes of the last watched tick. Valid until the next tick begins.
  const df::WorldView& view() const { return m_failed_world ? m_failed_world->view : m_world->view(); }
  /// Passes on the models published for the last tick, for games that use lag compensation.
  void onPublished(const Publisher& publisher) { m_world->onPublished(publisher); }
  /// Removes and returns the players that asked to leave in the last tick.
  std::vector<std::uint32_t> popLeavers() { return std::exchange(m_world->answer().leavers, {}); }
  /// Removes and returns the scores that the game added in the last tick, in order.
  std::vector<df::AddedScore> popScores();
  /// Takes the players to be moved to other rooms, as the game asked in the last tick (WorldPort::answer).
  std::vector<df::RoomTransfer> popSent() { return std::exchange(m_world->answer().sent, {}); }
  bool isGameOver() const { return m_world->answer().game_over; }
  /// Returns the number of ticks that have begun, with replayed ones.
  std::uint32_t ticks() const { return m_ticks; }
  /// Returns this player's picture, as the engine drew it in the last tick; blank if tick() asked for none.
  df::Canvas renderPlayer(std::uint32_t player) const;

  /// Ends the world's copies before a long pause, unless only they could resume the round. The next tick
  /// makes a new copy.
  void dropCheckpoints();

  // Replay of a killed server's round.

  /// Returns the replay's progress in percent; nullopt if there is none, or if its sessions have been taken.
  std::optional<int> recovering() const;
  /// Returns the sessions of the round's players until popSessions() returns them; then and without a
  /// recovery, none.
  std::vector<PersistedSession> awaitedSessions() const;
  /// Returns the sessions of the round's players, once, when the replay has ended.
  std::optional<std::vector<PersistedSession>> popSessions() {
    return std::exchange(m_sessions, std::nullopt);
  }
  /// Records a session's change in the journal, except in a recovery. Call before the client can know of it.
  void recordSession(const PersistedSession& session);

  // The round's end.

  /// Checks the world's process, and the journal. Call once in each tick of the host, even if the world is
  /// not ready; `tick` is the tick's number.
  void checkProcess(std::uint32_t tick);
  /// Returns how the round ended; nullopt while it continues.
  std::optional<WorldEnd> end() const { return m_unrecovered ? m_unrecovered : m_world->end(); }
  /// Returns a line for the log, once, if the current tick takes too long or the world's process is stopped.
  std::optional<std::string> popWarning();
  /// Begins to end the world, which takes time: end() is set when it has ended.
  void close() { m_world->close(std::exchange(m_turn, WorldTurn())); }
  /// Returns the report of a world that has taken over, only once for each; nullopt if there is none.
  std::optional<Failover> popFailover() { return std::exchange(m_failover, std::nullopt); }

 private:
  /// Knowledge about ticks that seem to hang.
  enum class Hangs : std::uint8_t {
    kUnknown,
    kOneEnded,  ///< one tick was ended, perhaps early for a copy to take over; it may only have been slow
    kSlow,      ///< a tick that seemed to hang has ended
    kReal,      ///< a tick did not end within the full time limit
  };
  /// State of a dead world, while another one replays its turns.
  struct FailedWorld {
    WorldEnd end;
    Clock::time_point at;
    std::uint32_t next_tick = 0;
    df::WorldView view;
  };

  void adopt(std::unique_ptr<WorldPort> world);
  void begin();
  void endTick();
  bool usesFastFailover() const;
  void onSlowTick();
  void onHang();
  void choosePicture();
  void sendTurn(WorldTurn turn);
  void storeResult();
  template <class Record>
  void store(const Record& record);
  void storeBytes(std::string_view records);
  void checkJournal();
  void finish(const std::string& why);
  void updatePlayers(const WorldTurn& turn);
  void beginReplay();
  void replayTurns();
  void closeRecovery();
  void endReplayedTick();
  void collectReplayedScores();
  void endRecovery(const std::string& problem);
  bool isFailingOver() const { return m_failed_world.has_value(); }
  std::uint32_t currentTick() const;
  bool startFailover(const WorldEnd& end);
  bool replayFromStart(bool drops_keys);
  bool replayFromCheckpoint();
  bool replayInNewWorld();
  void prepareReplay(std::size_t records);
  void requestCheckpoint();
  void logCheckpoints(const std::string& sentence) const;
  void finishFailover(const std::string& problem);

  std::unique_ptr<WorldPort> m_world;
  WorldProcess* m_p_process = nullptr;  ///< the world, if it is a process; otherwise null
  JournalBinding m_binding;
  RoundName m_name;
  std::function<void()> m_on_tick;
  bool m_is_recording;  ///< the journal is recording
  bool m_began = false;
  std::uint32_t m_tick_offset = 0;       ///< the host's tick numbers minus the world's own
  std::uint32_t m_ticks = 0;             ///< ticks begun by this world, with those before it was copied
  std::uint32_t m_recorded = 0;          ///< player whose picture the current tick records; 0: none
  std::vector<std::uint32_t> m_players;  ///< players in the world, in the order in which they joined
  std::uint32_t m_highest_player = 0;
  WorldTurn m_turn;  ///< the next turn
  SentTurn m_sent;   ///< the newest turn sent
  TurnRecordWriter m_writer;

  // Recovery.
  bool m_replaying = false;  ///< the replay has begun
  bool m_closing = false;    ///< the closing turn has been sent
  std::optional<std::vector<PersistedSession>> m_sessions;
  std::vector<df::AddedScore> m_scores;  ///< scores of replayed turns, which the server may not know
  std::optional<WorldEnd> m_unrecovered;

  // Takeover by another world.
  RoundHistory m_history;
  bool m_in_tick = false;
  bool m_by_checkpoint = false;  ///< the world that replays is a copy
  Hangs m_hangs = Hangs::kUnknown;
  std::optional<FailedWorld> m_failed_world;  ///< state of the previous world
  std::optional<std::uint32_t> m_failed_at;   ///< tick of the newest crash or hang
  std::optional<Failover> m_failover;
};

}  // namespace naiad
