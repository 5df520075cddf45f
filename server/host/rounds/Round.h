// A round: a world, and all that goes into it, which the owner of the round says here.
//
// What players do waits in the next turn. When its tick begins, the turn is spelled once: the journal, if
// there is one, stores these bytes before the world gets the same ones, and what came of it after.
//
// With a RoundRecovery the world first gets the turns of a round whose server was killed, as fast as it
// answers, and is ready when it has had all of them. In the same way another world takes over from one that
// crashed or hangs, without the keys and clicks of the tick in which that happened: a copy of it that is a
// few seconds old, or one that begins again.
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
class RepeatCheck;
class RoundRecovery;
class WorldProcess;

/// Names a round in the file of scores.
struct RoundName {
  std::string id;    ///< 32 hexadecimal digits that no other round has
  std::string file;  ///< its recording, from the folder of --journal; empty: it is not written down
};

/// Another world goes on in place of one that died.
struct TakeOver {
  bool by_copy = false;     ///< else it has executed the whole round
  std::uint32_t ticks = 0;  ///< that it has executed again
};

class Round {
 public:
  using Clock = std::chrono::steady_clock;

  /// Keys and clicks that wait for a tick, at most; those beyond are dropped.
  static constexpr std::size_t kMaxInputs = 16'384;

  /// Ticks between two hashes of the state, and between two pictures, of which the first comes earlier. A
  /// picture takes some 500 bytes of the file, a hash 8.
  static constexpr std::uint32_t kHashTicks = 30;
  static constexpr std::uint32_t kPictureTicks = 900;
  static constexpr std::uint32_t kFirstPicture = 300;

  /// A second death within so many ticks of the first one is the same: the round is over.
  static constexpr std::uint32_t kSameDeath = 30;

  /// Scores of a recovery's turns that are kept: those before them are in the server's file.
  static constexpr std::size_t kMaxScores = 4096;

  /// Where it is written, and what is to be said of it.
  struct Book {
    std::shared_ptr<JournalWriter> writer = nullptr;
    std::shared_ptr<Journal> journal = nullptr;  ///< null: it is not written down
    /// More facts, once the world has begun; empty: there are none.
    std::function<DfrFacts()> late_facts = {};
    /// The journal has stopped, and why; the game goes on.
    std::function<void(const std::string& problem)> on_problem = {};
    std::unique_ptr<RepeatCheck> check;       ///< whether the game is repeatable; null: unchecked
    std::unique_ptr<RoundRecovery> recovery;  ///< null: the round begins
    /// Of a recovery, once the world has begun: why it is not the world that the file has; empty: it is.
    std::function<std::string()> find_difference = {};
    /// Of a recovery, at its end: in how many ticks; or why the round cannot go on, and in which tick that
    /// showed.
    std::function<void(std::uint32_t ticks, const std::string& problem)> on_recovered = {};
    std::string recording = {};    ///< the file, from the folder of --journal
    std::string history = {};      ///< records of a recovery's round
    std::uint32_t first_tick = 0;  ///< the number that the host gave to its first tick; 0: unknown
    /// Starts another world of the same round, for a world that is a process; throws std::system_error.
    /// Empty: the round ends with its world.
    std::function<std::unique_ptr<WorldProcess>()> new_world = {};
    /// The world has ended so in this tick. `goes_on`: another one takes over.
    std::function<void(const WorldEnd& end, std::uint32_t tick, bool goes_on)> on_death = {};
    /// Another world has taken over, and how long that took.
    std::function<void(const TakeOver& done, std::chrono::milliseconds time)> on_taken_over = {};
    /// A sentence about copies, for the log.
    std::function<void(const std::string& sentence)> on_copies = {};
  };

  explicit Round(std::unique_ptr<WorldPort> world);
  explicit Round(std::unique_ptr<WorldProcess> world);
  Round(std::unique_ptr<WorldPort> world, Book book);
  Round(std::unique_ptr<WorldProcess> world, Book book);
  /// One that has not come to its end was stopped.
  ~Round();

  /// Called at the end of every tick: from tick(), or later from the host's event loop.
  void setOnTick(std::function<void()> on_tick) { m_on_tick = std::move(on_tick); }
  /// Of a round that is not written down the id is to be set.
  const RoundName& name() const { return m_name; }
  void setId(std::string id) { m_name.id = std::move(id); }

  // Input, in the order it came. It counts from nextTick() on.

  /// Adds an input to the next turn. Drops keys and clicks beyond kMaxInputs.
  void addInput(df::InputQueue::Input input);
  /// In the next tick only this player's input comes; 0: all players'.
  void setHeard(std::uint32_t player) { m_turn.heard_player = player; }
  /// Ends the game: at once if its world is in this process, else at the end of the next tick.
  void endGame();

  // Ticks.

  /// May one begin?
  bool isReady() const { return !m_book.recovery && m_world->isReady(); }
  /// Begin one. `watched`: view() is wanted; the first time with every Object as changed. `truth`:
  /// renderPlayer() is, too, of all players or only of `pictured`.
  void tick(bool watched, bool truth, std::uint32_t pictured = 0);
  /// The number of the next tick to begin, by which view() counts.
  std::uint32_t nextTick() const { return m_death ? m_death->next_tick : m_world->nextTick(); }
  /// What the last watched tick changed. Valid until the next one begins.
  const df::WorldView& view() const { return m_death ? m_death->view : m_world->view(); }
  /// These models have been published for the last tick: for games that use lag compensation.
  void notePublished(const Publisher& publisher) { m_world->notePublished(publisher); }
  /// The players who wanted to leave in the last tick.
  std::vector<std::uint32_t> takeLeavers() { return std::exchange(m_world->answer().leavers, {}); }
  /// The scores that the game added in the last tick, in that order.
  std::vector<df::AddedScore> takeScores();
  /// What the game asked for in the last tick: players to be moved to other rooms (WorldPort::answer).
  std::vector<df::SentPlayer> takeSent() { return std::exchange(m_world->answer().sent, {}); }
  bool isGameOver() const { return m_world->answer().game_over; }
  /// What this player sees, as the engine drew it in the last tick.
  df::Canvas renderPlayer(std::uint32_t player) const;

  /// The world is to stand still for long: its copies end, unless only they could go on with the round. The
  /// next tick makes one.
  void dropCopies();

  // A round of a server that was killed, which is executed again until it is where it was.

  /// How far that is, in percent; nothing: there is no such round, or its sessions have been taken.
  std::optional<int> recovering() const;
  /// Once, when recovering() has come to its end: the sessions that its players had.
  std::optional<std::vector<KeptSession>> takeSessions() { return std::exchange(m_sessions, std::nullopt); }
  /// A player's session is so from now on: for the journal, before its client can know.
  void noteSession(const KeptSession& session);

  // Its end.

  /// Look after the world's process, and the journal. Once in each tick of the host, ready or not; `tick` is
  /// its number.
  void checkProcess(std::uint32_t tick);
  /// How it ended; nothing while it goes on.
  std::optional<WorldEnd> end() const { return m_unrecovered ? m_unrecovered : m_world->end(); }
  /// A line for the log, once: the tick does not end.
  std::optional<std::string> takeWarning();
  /// Let it come to its end; end() says when it has.
  void close() { m_world->close(std::exchange(m_turn, WorldTurn())); }
  /// Once, when another world has taken over from one that died.
  std::optional<TakeOver> takeTakeOver() { return std::exchange(m_taken_over, std::nullopt); }

 private:
  /// What is known of ticks that seem to hang.
  enum class Hangs : std::uint8_t {
    kUnknown,
    kOneEnded,  ///< once a copy took over at once; whether the tick would have ended is not known
    kSlow,      ///< such a tick came to its end
    kReal,      ///< one did not, however long it was waited for
  };
  /// Of a world, while another one has its turns.
  struct Death {
    WorldEnd end;
    Clock::time_point at;
    std::uint32_t next_tick = 0;
    df::WorldView view;
  };

  explicit Round(Book book);
  void adopt(std::unique_ptr<WorldPort> world);
  void adopt(std::unique_ptr<WorldProcess> world);
  void begin();
  void endTick();
  bool isImpatient() const;
  void noteSlowTick();
  void noteHang();
  void choosePicture();
  void sendTurn(WorldTurn turn);
  void storeResult();
  template <class Record>
  void store(const Record& record);
  void storeBytes(std::string_view records);
  void checkJournal();
  void finish(const std::string& why);
  void notePlayers(const WorldTurn& turn);
  void beginRepetition();
  void repeatTurns();
  void closeRecovery();
  void endRepeatedTick();
  void keepRepeatedScores();
  void endRecovery(const std::string& problem);
  bool isTakingOver() const { return m_death.has_value(); }
  std::uint32_t currentTick() const;
  bool takeOver(const WorldEnd& end);
  bool beginAgain(bool drops_keys);
  bool repeatByCopy();
  bool repeatByAnother();
  void prepareToRepeat(std::size_t records);
  void orderCopy();
  void say(const std::string& sentence_of_copies) const;
  void endTakeOver(const std::string& problem);

  std::unique_ptr<WorldPort> m_world;
  WorldProcess* m_p_process = nullptr;  ///< the same; null: it is no process
  Book m_book;
  RoundName m_name;
  std::function<void()> m_on_tick;
  bool m_goes_on;  ///< the journal
  bool m_began = false;
  std::uint32_t m_later = 0;             ///< the host's tick numbers minus the world's own
  std::uint32_t m_ticks = 0;             ///< begun, of this world
  std::uint32_t m_recorded = 0;          ///< whose picture the tick that is under way gives; 0: none
  std::vector<std::uint32_t> m_players;  ///< that have joined and not left, in order
  WorldTurn m_turn;                      ///< the next one
  SentTurn m_sent;                       ///< the one before
  TurnRecordWriter m_writer;

  // Of a recovery.
  bool m_repeating = false;  ///< it has begun
  bool m_closing = false;    ///< the world has been sent the turn behind those of the file
  std::optional<std::vector<KeptSession>> m_sessions;
  std::vector<df::AddedScore> m_scores;  ///< of repeated turns, which the server may not know
  std::optional<WorldEnd> m_unrecovered;

  // Of a world that takes over.
  RoundHistory m_history;
  bool m_in_tick = false;
  bool m_by_copy = false;  ///< the world that has the turns again is one
  Hangs m_hangs = Hangs::kUnknown;
  std::optional<Death> m_death;            ///< of the world before
  std::optional<std::uint32_t> m_died_at;  ///< tick
  std::optional<TakeOver> m_taken_over;
};

}  // namespace naiad
