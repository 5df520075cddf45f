// A world in a process of its own, over a Unix socket (WorldMessages.h). The other end is a WorldServer.
//
// A world that does not answer in time, or sends a malformed frame, is killed; one that crashes has ended.
// The host goes on without it. Of a tick only that time counts which is the world's own doing (TickEffort.h):
// a machine under load and a debugger do not make a game hang.
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
#include "host/world/TickEffort.h"
#include "host/world/WorldCopies.h"
#include "host/world/WorldLauncher.h"
#include "host/world/WorldMessages.h"
#include "host/world/WorldPort.h"

namespace naiad {

/// WorldAnswer::hash of an answer's fields.
std::uint64_t hashAnswer(std::string_view fields);

class WorldProcess : public WorldPort {
 public:
  using Clock = std::chrono::steady_clock;

  /// So many times StartedWorld::hang_time for an answer, and it is killed: a game may load something once in
  /// a while. After one time takeWarning() says that it hangs; then it is killed at once if setImpatient()
  /// and a copy is ready, and all of that time is surely its own doing (TickEffort::own()).
  static constexpr int kPatience = 5;
  /// From the start of the process to GM.run(), and for the first tick.
  static constexpr std::chrono::seconds kStartTime{30};
  /// From the end of the game to that of its process: what main() does after GM.run().
  static constexpr std::chrono::seconds kEndTime{1};
  /// Of turnsAhead(): some milliseconds of most games.
  static constexpr std::uint32_t kTurnsAhead = 32;

  /// Takes over the process and the descriptors. `home` runs its handlers. `print`: gets the lines that it
  /// prints, from checkProcess(); empty: they are dropped.
  WorldProcess(asio::io_context& home, const StartedWorld& started, OutputRelay::Line print = {});
  /// Kills it and all that it has started, if it has not ended.
  ~WorldProcess() override;
  WorldProcess(const WorldProcess&) = delete;
  WorldProcess& operator=(const WorldProcess&) = delete;

  bool isReady() const override { return m_state == State::kReady && m_keeper_is != Keeper::kStarting; }
  void tick(const SentTurn& turn) override;
  /// Before the first tick: that of the host's. From there on it counts its own.
  std::uint32_t nextTick() const override { return m_next_tick; }
  std::uint32_t turnsAhead() const override { return kTurnsAhead; }
  const df::WorldView& view() const override { return m_view; }
  void checkProcess(std::uint32_t tick) override;
  std::optional<WorldEnd> end() const override { return m_end; }
  void close(const WorldTurn& rest = {}) override;

  /// A line for the log, once: the tick does not end.
  std::optional<std::string> takeWarning() { return std::exchange(m_warning, std::nullopt); }
  /// Where a copy is ready to go on, a tick that seems to hang is not waited for.
  void setImpatient(bool impatient) { m_impatient = impatient; }
  /// Did the last tick seem to hang, and came to its end?
  bool wasSlow() const { return m_was_slow; }
  /// That its process has taken, of all processors; 0: unknown.
  std::chrono::nanoseconds cpuTime() const;
  /// What it prints from now on was not printed before.
  void endRepetition();
  /// It is not to go on: it ends as one that crashed.
  void giveUp(const std::string& why) { fail(WorldEnd::kCrashed, why); }

  // Copies of its process: one goes on where the world has crashed or hangs.

  /// Keep a copy of the world as it is after the next tick, beside the one before. False: there will be none.
  bool keepCopy();
  /// May one be asked for? While the keeper ends what is left of a world before, it would end the copy, too.
  bool canKeepCopy() const { return m_keeper_is == Keeper::kWatching; }
  /// Those that are kept end.
  void dropCopies() { m_copies.clear(); }
  /// Why there are none any more, once, in words.
  std::optional<std::string> takeCopyProblem() { return m_copies.takeProblem(); }
  /// After end(): the newest copy is the world from now on, as it was after its tick: return how many it has
  /// had since the world's first. What it prints is dropped until endRepetition(). Nothing: there is none
  /// left, and no process of the world is.
  std::optional<std::uint32_t> goOnWithCopy();

  /// What the game has set up by GM.run(); nothing before.
  const std::optional<WorldReady>& ready() const { return m_ready; }

 private:
  enum class State {
    kStarting,
    kReady,
    kTicking,
    kEnding,  ///< the socket is closed, or will be, and the process comes to its end
    kEnded,
  };
  enum class Keeper : std::uint8_t {
    kStarting,
    kWatching,
    kClearing,  ///< ends what is left of the world before
    kEnded,     ///< and with it all that the world had started
  };

  void beginTick();
  void sendTurns();
  void readHead();
  void readFields();
  void onFrame();
  void takeReady();
  void hangUp();
  void fail(WorldEnd::Why why, const std::string& text);
  void finish(int status);
  WorldEnd endOf(int status) const;
  std::string when() const;
  std::string activity(std::string_view verb) const;
  std::vector<std::string> lastLines() const;
  void readKeeper(int patience_millis);
  template <class Message>
  std::optional<Message> takeFromKeeper(int patience_millis);
  std::chrono::nanoseconds patience() const;
  bool isGivenUpEarly() const;
  bool isInFirstTick() const { return currentTick() == m_later + 1; }
  /// The one that the world is at, or was at last.
  std::uint32_t currentTick() const;
  void countTime(Clock::time_point now);
  void warnOfHang();
  void kill();
  void killWorld();
  void waitForKeeper();
  bool orderToGoOn(const WorldCopy& copy);
  void become(WorldCopy copy);

  asio::local::stream_protocol::socket m_socket;
  int m_keeper;  ///< the socket of its keeper
  OutputRelay::Line m_print;
  OutputRelay m_output;
  const df::ActivityPage* m_p_page = nullptr;  ///< null: there is none
  const std::chrono::nanoseconds m_hang_time;
  Keeper m_keeper_is = Keeper::kStarting;
  pid_t m_process = -1;  ///< as the keeper says
  State m_state = State::kStarting;
  std::optional<WorldReady> m_ready;
  std::optional<int> m_status;        ///< once it has ended
  std::optional<WorldEnd> m_failure;  ///< why it was killed
  std::optional<WorldEnd> m_end;
  Clock::time_point m_checked_at;
  std::chrono::nanoseconds m_waited{0};  ///< in this state; time between two checks counts up to a limit
  TickEffort m_effort;                   ///< of the tick that is under way
  std::uint32_t m_next_tick = 1;
  std::uint32_t m_later = 0;  ///< the host's tick numbers minus the world's own
  bool m_began = false;
  bool m_impatient = false;
  bool m_warned = false;      ///< of this tick, that it hangs
  bool m_was_slow = false;    ///< m_warned of the tick before
  bool m_stop_noted = false;  ///< of this tick, that it is stopped
  std::optional<std::string> m_warning;
  bool m_expected = false;         ///< to end: the game is over, or the host closed it
  const bool m_hashes;             ///< its answers
  std::uint32_t m_unanswered = 0;  ///< turns that were sent
  std::string m_unsent;
  std::string m_out;  ///< that is being sent
  bool m_sending = false;
  std::string m_in;
  std::optional<ViewReader> m_views;
  df::WorldView m_view;
  WorldCopies m_copies;
  bool m_copied = false;  ///< behind the next turn, or the one under way
  bool m_repeats;         ///< what it prints was printed
  std::shared_ptr<WorldProcess*> m_self = std::make_shared<WorldProcess*>(this);  ///< handlers may come later
};

}  // namespace naiad
