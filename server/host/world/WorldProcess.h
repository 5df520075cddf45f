// A world in a process of its own, over a Unix socket (WorldMessages.h). The other end is a WorldServer.
//
// A world that does not answer in time, or sends a malformed frame, is killed; the host continues without it.
// Only the time of a tick that the world itself caused counts (TickStallMeter.h): a loaded machine or a
// debugger does not make a game hang.
#pragma once

#include <asio/io_context.hpp>
#include <asio/local/stream_protocol.hpp>
#include <chrono>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/world/ActivityPage.h"
#include "host/world/OutputRelay.h"
#include "host/world/TickStallMeter.h"
#include "host/world/WorldCheckpoints.h"
#include "host/world/WorldLauncher.h"
#include "host/world/WorldMessages.h"
#include "host/world/WorldPort.h"

namespace naiad {

/// Returns the WorldAnswer::hash of an answer's fields.
std::uint64_t hashAnswer(std::string_view fields);

class WorldProcess : public WorldPort {
 public:
  using Clock = std::chrono::steady_clock;

  /// Time limit of an answer, in multiples of StartedWorld::hang_time; it is generous because games load
  /// files in handlers. After one hang_time popWarning() reports a hang. After its first tick, a
  /// world is killed after one hang_time already if setFastFailover() is set, a copy is ready, and all of
  /// that time is certainly the world's own (TickStallMeter::own()).
  static constexpr int kAnswerTimeoutFactor = 5;
  /// Time limit from the start of the process to GM.run(). The first tick's time limit is at least this, too.
  static constexpr std::chrono::seconds kStartTime{30};
  /// Time limit from the end of the game to that of its process, in which main() continues after GM.run().
  static constexpr std::chrono::seconds kEndTime{1};
  /// Value of turnsAhead(): as many ticks as most games execute in some milliseconds.
  static constexpr std::uint32_t kTurnsAhead = 32;

  /// Takes over the process and the descriptors. `home` runs the handlers of this object. `print` gets the
  /// lines that the world prints, from checkProcess(). If `print` is empty, they are dropped.
  WorldProcess(asio::io_context& home, const StartedWorld& started, OutputRelay::Line print = {});
  /// Kills the world and all its descendants, if they have not ended, and waits some seconds for their end.
  ~WorldProcess() override;
  WorldProcess(const WorldProcess&) = delete;
  WorldProcess& operator=(const WorldProcess&) = delete;

  bool isReady() const override {
    return m_state == State::kReady && m_supervisor_state != SupervisorState::kStarting;
  }
  void tick(const SentTurn& turn) override;
  /// Before the first tick, this is the host's tick number. Afterwards each tick of the world adds 1.
  std::uint32_t nextTick() const override { return m_next_tick; }
  std::uint32_t turnsAhead() const override { return kTurnsAhead; }
  const df::WorldView& view() const override { return m_view; }
  void checkProcess(std::uint32_t tick) override;
  std::optional<WorldEnd> end() const override { return m_end; }
  void close(const WorldTurn& rest = {}) override;

  /// Returns a warning for the log, only once, if the tick takes too long or the process is stopped in it.
  std::optional<std::string> popWarning() { return std::exchange(m_warning, std::nullopt); }
  /// Sets whether a world whose tick seems to hang is killed early if a copy is ready.
  void setFastFailover(bool impatient) { m_fast_failover = impatient; }
  /// True if the last tick seemed to hang, but ended.
  bool wasTickSlow() const { return m_was_slow; }
  /// Returns the processor time of the world's process; 0: unknown.
  std::chrono::nanoseconds cpuTime() const;
  /// Ends a replay: from now on the world's output is printed.
  void endReplay();
  /// Ends the world as if it had crashed.
  void markFailed(const std::string& why) { fail(WorldEnd::kCrashed, why); }

  // Copies of the world's process. One of them takes over if the world has crashed or hangs.

  /// Requests a copy after the next tick, in addition to earlier ones. Returns false if there will be none.
  bool requestCheckpoint();
  /// True if a copy may be requested. False while the supervisor kills what is left of a previous world,
  /// because it would kill the copy, too.
  bool canRequestCheckpoint() const { return m_supervisor_state == SupervisorState::kWatching; }
  /// Ends all copies.
  void dropCheckpoints() { m_checkpoints.clear(); }
  /// Returns the reason if copies have become impossible, only once.
  std::optional<std::string> popCheckpointProblem() { return m_checkpoints.popProblem(); }
  /// Replaces the world by the newest copy, in the state after the copy's tick. Call when end() has a value.
  /// Returns how many ticks the world had executed in that state; nullopt if there is no copy, and then no
  /// process of the world is left. The copy's output is dropped until endReplay().
  std::optional<std::uint32_t> resumeFromCheckpoint();

  /// Returns the game's settings; nullopt before GM.run().
  const std::optional<WorldReady>& ready() const { return m_ready; }

 private:
  enum class State {
    kStarting,
    kReady,
    kTicking,
    kEnding,  ///< the socket is closed, or will be, and the process is ending
    kEnded,
  };
  enum class SupervisorState : std::uint8_t {
    kStarting,
    kWatching,
    kClearing,  ///< it kills what is left of the previous world
    kEnded,     ///< it has ended all descendants of the world, and itself
  };

  void beginTick();
  void sendTurns();
  void readHead();
  void readFields();
  void onFrame();
  void handleReady();
  void closeSocket();
  void fail(WorldEnd::Why why, const std::string& text);
  void finish(int status);
  WorldEnd endOf(int status) const;
  std::string when() const;
  std::string activity(std::string_view verb) const;
  std::vector<std::string> lastLines() const;
  void readSupervisor(int timeout_millis);
  template <class Message>
  std::optional<Message> receiveFromSupervisor(int timeout_millis);
  std::chrono::nanoseconds answerTimeout() const;
  bool isFailedEarly() const;
  bool isInFirstTick() const { return currentTick() == m_tick_offset + 1; }
  /// Returns the tick that the world is in, or was in last.
  std::uint32_t currentTick() const;
  void countTime(Clock::time_point now);
  void warnOfHang();
  void kill();
  void killWorld();
  void waitForSupervisor();
  bool commandResume(const WorldCheckpoint& copy);
  void switchTo(WorldCheckpoint copy);

  asio::local::stream_protocol::socket m_socket;
  int m_supervisor;  ///< our end of the supervisor's socket
  OutputRelay::Line m_print;
  OutputRelay m_output;
  const df::ActivityPage* m_p_page = nullptr;  ///< null: no page
  const std::chrono::nanoseconds m_hang_time;
  SupervisorState m_supervisor_state = SupervisorState::kStarting;
  pid_t m_process = -1;  ///< as reported by the supervisor
  State m_state = State::kStarting;
  std::optional<WorldReady> m_ready;
  std::optional<int> m_status;        ///< the world's status as of waitpid(), once it has ended
  std::optional<WorldEnd> m_failure;  ///< why the world was killed
  std::optional<WorldEnd> m_end;
  Clock::time_point m_checked_at;
  std::chrono::nanoseconds m_waited{0};  ///< time in this state; a check adds at most kMaxBetweenChecks
  TickStallMeter m_stall;                ///< time of the current tick, as far as it counts
  SlowTickDetector m_slow_tick;
  std::uint32_t m_next_tick = 1;
  std::uint32_t m_tick_offset = 0;  ///< the host's tick numbers minus the world's own
  bool m_began = false;
  bool m_fast_failover = false;
  bool m_warned = false;      ///< true if a hang of this tick was reported
  bool m_was_slow = false;    ///< true if a hang of the previous tick was reported
  bool m_stop_noted = false;  ///< true if a stop of the process in this tick was reported
  std::optional<std::string> m_warning;
  bool m_expected = false;         ///< true if the end is expected: the game is over, or the host closed it
  const bool m_hashes;             ///< true if answers are hashed
  std::uint32_t m_unanswered = 0;  ///< turns that were sent and not answered
  std::string m_unsent;
  std::string m_out;  ///< bytes being sent
  bool m_sending = false;
  std::string m_in;
  std::optional<ViewReader> m_views;
  df::WorldView m_view;
  WorldCheckpoints m_checkpoints;
  bool m_copied = false;  ///< true if a copy will be made after the next or the current turn
  bool m_repeats;         ///< true in a replay, whose output was printed before
  std::shared_ptr<WorldProcess*> m_self =
      std::make_shared<WorldProcess*>(this);  ///< lets late handlers see that this is gone
};

}  // namespace naiad
