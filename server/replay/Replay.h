// A round that is executed again, tick by tick, and held against what its file says.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "host/world/TurnRecord.h"
#include "host/world/WorldLauncher.h"
#include "server/replay/RecordedRound.h"

namespace naiad {

/// A world that is executed again: a process of its own, which gets one turn after the other as fast as it
/// answers.
/// On one thread, which waits for the world.
class ReplayWorld {
 public:
  /// For an answer; then the world hangs.
  static constexpr std::chrono::seconds kPatience{30};

  /// Starts it, and waits until the game runs. Throws std::system_error.
  ReplayWorld(const WorldLauncher& launcher, const WorldOrder& order);
  /// It ends.
  ~ReplayWorld();
  ReplayWorld(const ReplayWorld&) = delete;
  ReplayWorld& operator=(const ReplayWorld&) = delete;

  /// What the game has set up; nothing if it ended before.
  const std::optional<WorldReady>& ready() const { return m_ready; }
  /// What the world answers to this turn, valid until the next one: the fields of its frame. Nothing: it has
  /// ended, and failure() says how.
  std::optional<std::string_view> step(const WorldTurn& turn);
  /// "did not answer any more"; empty while it answers.
  const std::string& failure() const { return m_failure; }
  /// The number of its process; -1: it was never one.
  int process() const { return m_process; }
  /// From now on wait for answers for as long as it takes, or until this descriptor is readable; then the
  /// world does not answer any more.
  void waitAlsoFor(int descriptor) { m_also = descriptor; }
  /// After a failure: how its process ended, as of waitpid(); nothing: it has not.
  std::optional<int> takeEnd();
  /// What it printed last.
  const std::string& printed() const { return m_printed; }

 private:
  bool send(std::string_view bytes);
  bool receive(char* p_to, std::size_t count);
  bool receiveFrame();
  bool wait(short events);
  void readOutput();

  StartedWorld m_started;
  int m_process = -1;
  int m_also = -1;
  std::optional<WorldReady> m_ready;
  TurnRecordWriter m_turns;
  std::string m_answer;
  std::string m_failure;
  std::string m_printed;
};

class Replay {
 public:
  /// Starts the world. Throws RoundError if the game does not run, or std::system_error.
  Replay(const RecordedRound& round, const RoundStage& stage);

  /// Execute the next recorded turn. `pictures`: of all players, where the turn does not ask for them; then
  /// the answer is not the recorded one, and only the state is compared. False: there are no more, or the
  /// world has ended.
  bool step(bool pictures = false);
  /// Does the file have a turn behind those that were executed?
  bool hasNextTurn() const { return m_next && std::holds_alternative<WorldTurn>(*m_next); }
  /// In this tick the world gets the keys and clicks that were left out later, because it died by them.
  void keepDroppedKeys(std::uint32_t tick) { m_kept_tick = tick; }
  /// Read the scores of each tick's answer, too.
  void readScores() { m_reads_scores = true; }
  /// Ticks executed so far.
  std::uint32_t tick() const { return m_tick; }

  // Of the last tick.

  const WorldTurn& turn() const { return m_turn; }
  /// What the players saw, as far as it was asked for.
  const std::vector<WorldPicture>& pictures() const { return m_pictures; }
  /// What the game added, after readScores().
  const std::vector<df::AddedScore>& scores() const { return m_scores; }
  /// What the file has of it.
  const std::optional<RecordedPicture>& recordedPicture() const { return m_recorded; }
  /// Was it other than the file says?
  bool differs() const { return m_differs; }

  /// The first tick that was; 0: none so far.
  std::uint32_t firstDifference() const { return m_first_difference; }
  /// What of it was: "the world's answer", "the state".
  const std::string& whatDiffers() const { return m_what_differs; }
  /// How the world ended before its recorded end; empty: it did not.
  const std::string& failure() const { return m_failure; }
  /// Files that the game reads and that are other ones than they were.
  const std::vector<std::string>& otherFiles() const { return m_other_files; }
  /// Does it have the addresses that it had?
  bool hasFixedAddresses() const { return m_world.ready()->fixed_addresses; }
  ReplayWorld& world() { return m_world; }
  DfrEnd end() const { return m_reader->end(); }
  const std::string& why() const { return m_reader->why(); }

 private:
  void readAhead();
  bool nextTurn();
  void takeRest(std::string_view answer, bool exact);
  void compare(const TickResult& result, std::string_view answer, bool exact);
  void noteDifference(const char* what);
  void compareFiles(const RecordedRound& round);

  std::unique_ptr<DfrReader> m_reader;
  ReplayWorld m_world;
  std::optional<TurnRecord> m_next;  ///< read ahead
  std::uint32_t m_tick = 0;
  std::uint32_t m_kept_tick = 0;  ///< 0: none
  WorldTurn m_turn;
  std::vector<WorldPicture> m_pictures;
  bool m_reads_scores = false;
  std::vector<df::AddedScore> m_scores;
  std::optional<RecordedPicture> m_recorded;
  bool m_differs = false;
  std::uint32_t m_first_difference = 0;
  std::string m_what_differs;
  std::string m_failure;
  std::vector<std::string> m_other_files;
};

}  // namespace naiad
