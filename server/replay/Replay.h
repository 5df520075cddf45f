// Replays a round tick by tick, and compares it with its file.
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

/// A world that is replayed: a process of its own, which gets each turn once it has answered the previous
/// one. Single-threaded: the calling thread waits for the world.
class ReplayWorld {
 public:
  /// Time limit for an answer; after it the world counts as hung.
  static constexpr std::chrono::seconds kResponseTimeout{30};

  /// Starts the world, and waits until the game runs. Throws std::system_error.
  ReplayWorld(const WorldLauncher& launcher, const WorldStartOptions& order);
  /// Ends the world.
  ~ReplayWorld();
  ReplayWorld(const ReplayWorld&) = delete;
  ReplayWorld& operator=(const ReplayWorld&) = delete;

  /// Returns the game's settings; nullopt if it failed before GM.run() (see failure()).
  const std::optional<WorldReady>& ready() const { return m_ready; }
  /// Executes a turn. Returns the fields of the world's answer, valid until the next turn; nullopt if the
  /// world has failed (see failure()).
  std::optional<std::string_view> step(const WorldTurn& turn);
  /// Returns how the world failed, for example "stopped answering"; empty while it answers.
  const std::string& failure() const { return m_failure; }
  /// Returns the id of the world's process; -1 if the game never ran (see ready()).
  int process() const { return m_process; }
  /// Removes the time limit of answers. Instead, the world counts as hung when this descriptor is readable.
  void setCancelDescriptor(int descriptor) { m_cancel_descriptor = descriptor; }
  /// Call after a failure: returns the exit status of the world's process, in the format of waitpid().
  /// Returns nullopt if the process has not ended, or its end is not reported within 2 s.
  std::optional<int> popExitStatus();
  /// Returns the last part of the world's output.
  const std::string& printed() const { return m_printed; }

 private:
  bool send(std::string_view bytes);
  bool receive(char* p_to, std::size_t count);
  bool receiveFrame();
  bool wait(short events);
  void readOutput();

  StartedWorld m_started;
  int m_process = -1;
  int m_cancel_descriptor = -1;
  std::optional<WorldReady> m_ready;
  TurnRecordWriter m_turns;
  std::string m_answer;
  std::string m_failure;
  std::string m_printed;
};

class Replay {
 public:
  /// Starts the world. Throws RoundError if the game does not run, or std::system_error.
  Replay(const RecordedRound& round, const ReplayEnvironment& environment);

  /// Executes the next recorded turn. `pictures`: requests the pictures of all players; if the turn did not
  /// ask for them, only the state is compared, because the answer is not the recorded one. Returns false if
  /// there are no more turns, or the world has failed.
  bool step(bool pictures = false);
  /// True if the file has a turn after those that were executed.
  bool hasNextTurn() const { return m_next && std::holds_alternative<WorldTurn>(*m_next); }
  /// Makes the world get the keys and clicks of this tick that the server dropped when it repeated the tick
  /// after a crash or hang.
  void restoreDroppedInputs(std::uint32_t tick) { m_restored_tick = tick; }
  /// Makes step() also read the scores in each answer, for scores().
  void readScores() { m_reads_scores = true; }
  /// Returns the number of ticks executed so far.
  std::uint32_t tick() const { return m_tick; }

  // Results of the last tick.

  const WorldTurn& turn() const { return m_turn; }
  /// Returns the players' pictures that were requested.
  const std::vector<WorldPicture>& pictures() const { return m_pictures; }
  /// Returns the scores that the game added; needs readScores().
  const std::vector<df::AddedScore>& scores() const { return m_scores; }
  /// Returns the picture that the file has of this tick.
  const std::optional<RecordedPicture>& recordedPicture() const { return m_recorded; }
  /// True if the tick differed from the file.
  bool differs() const { return m_differs; }

  /// Returns the first tick that differed; 0: none so far.
  std::uint32_t firstDifference() const { return m_first_difference; }
  /// Returns what differed in that tick, for example "the state".
  const std::string& differenceText() const { return m_difference_text; }
  /// Returns how the world failed before its recorded end; empty if it did not.
  const std::string& failure() const { return m_failure; }
  /// Returns the files that the game has read before GM.run() and that are not the recorded ones.
  const std::vector<std::string>& changedFiles() const { return m_changed_files; }
  /// True if the world has its recorded addresses.
  bool hasFixedAddresses() const { return m_world.ready()->fixed_addresses; }
  ReplayWorld& world() { return m_world; }
  DfrEnd end() const { return m_reader->end(); }
  const std::string& endReason() const { return m_reader->endReason(); }

 private:
  void readAhead();
  bool nextTurn();
  void consumeTickRecords(std::string_view answer, bool exact);
  void compare(const TickResult& result, std::string_view answer, bool exact);
  void recordDifference(const char* what);
  void compareFiles(const RecordedRound& round);

  std::unique_ptr<DfrReader> m_reader;
  ReplayWorld m_world;
  std::optional<TurnRecord> m_next;  ///< read ahead
  std::uint32_t m_tick = 0;
  std::uint32_t m_restored_tick = 0;  ///< 0: none
  WorldTurn m_turn;
  std::vector<WorldPicture> m_pictures;
  bool m_reads_scores = false;
  std::vector<df::AddedScore> m_scores;
  std::optional<RecordedPicture> m_recorded;
  bool m_differs = false;
  std::uint32_t m_first_difference = 0;
  std::string m_difference_text;
  std::string m_failure;
  std::vector<std::string> m_changed_files;
};

}  // namespace naiad
