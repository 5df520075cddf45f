// Hosts a game: the Runner behind GM.run() in dfserver.
//
// The thread that calls run() owns worlds and sessions; the sockets have their own thread (NetworkThread.h).
// Between two ticks it serves streams; at the deadline it runs the tick. HostEndpoint.h has the listening
// sockets, HostClients.h the players, HostControls.h commands to the host, HostPart.h optional parts.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "engine/world/Runner.h"

namespace naiad {

class HostClients;
class HostControls;
class HostEndpoint;
class HostPart;
class AsyncLog;
class TickClock;
class Watchdog;
struct ForcedExit;
struct HostContext;
struct HostOptions;
struct LogEvent;

class Host : public df::Runner {
 public:
  using Log = std::function<void(const LogEvent& event)>;

  /// Starts to listen; clients wait until run(). Throws ListenError (also for the metrics port, a control
  /// socket given by path and, with HostOptions::lan "on", LAN queries), TlsError for unusable keys,
  /// PasswordError, BanFileError, or std::runtime_error for a truth or status file that cannot be written.
  Host(HostOptions options, std::string game, Log log);
  ~Host() override;

  HostContext& context() const { return *m_context; }
  HostEndpoint& endpoint() const { return *m_endpoint; }
  HostClients& clients() const { return *m_clients; }
  HostControls& controls() const { return *m_controls; }

  /// Ticks the world, by default 30 times a second, until the game is over, or a signal, command or option
  /// ends it. Then sends the players a goodbye, unless another program continues their round, and waits, at
  /// most a second, until queued data is sent. If a signal arrives while the game hangs in a tick, the
  /// process exits with code 1. A second signal ends it at once, by that signal unless the game hangs. Both
  /// send a goodbye first.
  ///
  /// If the game ends itself, in a world of this process, a further run may follow, as after a title. So
  /// players stay connected without a goodbye, and join the world again in the next run(). A client that
  /// hears nothing for 15 s begins to reconnect. After any other end, run() ends at once.
  void run(df::World& world) override;
  /// True between two runs: connections wait for the next one.
  bool awaitsRun() const { return m_p_world != nullptr; }
  /// Ends a host that awaits a run as run() does otherwise. Call this before the destructor.
  void finish();
  /// Ends run() after the present tick, with this sentence to the players. Any thread.
  void stop(const std::string& sentence);
  /// Calls `job` on the host's thread between ticks. Any thread may post. Tests inspect worlds with it.
  void post(std::function<void(df::World&)> job);
  /// Sets a function to call after every tick, on the host's thread.
  void setObserver(std::function<void(df::World&)> observer) { m_observer = std::move(observer); }

 private:
  using Clock = std::chrono::steady_clock;

  void beginGame(df::World& world);
  void endGame(df::World& world);
  void applySettings(df::World& world);
  void serveUntil(Clock::time_point deadline);
  bool isDue(TickClock& schedule);
  bool isResting() const;
  TickClock rest();
  void tick(Watchdog& watchdog);
  void tickWorlds(Watchdog& watchdog);
  [[noreturn]] void endProcess(const ForcedExit& end, AsyncLog& log);
  void flush();
  void sweep();
  void sendGoodbyes();
  void drain();
  void logEnd() const;
  bool isOver() const;
  bool isDeserted(Clock::time_point now) const;

  std::unique_ptr<HostContext> m_context;
  std::unique_ptr<HostEndpoint> m_endpoint;
  std::unique_ptr<HostClients> m_clients;
  std::unique_ptr<HostControls> m_controls;
  std::vector<std::unique_ptr<HostPart>> m_parts;
  std::function<void(df::World&)> m_observer;
  df::World* m_p_world = nullptr;  ///< null before the first run and after the last
  bool m_finished = false;
  Clock::time_point m_empty_since;
  Clock::time_point m_tick_began;
};

}  // namespace naiad
