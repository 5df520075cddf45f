// A world that is executed again: a process of its own, which gets one turn after the other as fast as it
// answers.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <string_view>

#include "host/world/TurnRecord.h"
#include "host/world/WorldLauncher.h"

namespace naiad {

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

}  // namespace naiad
