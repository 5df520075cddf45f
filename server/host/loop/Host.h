// Hosts a game: the Runner behind GM.run() in dfserver.
//
// The thread that runs `run` owns worlds and sessions; the sockets have a thread of their own
// (NetworkThread.h). Between two ticks it serves streams, at the deadline it runs the tick. `run` is the
// loop, `tick` one turn of it. HostEndpoint.h is where it listens, HostClients.h who plays, HostControls.h
// what can be asked of it, HostPart.h what else it may have.
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
class SideLog;
class TickClock;
class Watchdog;
struct ForcedEnd;
struct HostContext;
struct HostOptions;
struct LogEvent;

class Host : public df::Runner {
 public:
  using Log = std::function<void(const LogEvent& event)>;

  /// Listens from now on (clients wait until run()). Throws ListenError (with HostOptions::lan "on" for the
  /// socket of the local network's queries, too), TlsError for keys that cannot be used, or
  /// std::runtime_error for a truth or status file that cannot be written.
  Host(HostOptions options, std::string game, Log log);
  ~Host() override;

  HostContext& context() const { return *m_context; }
  HostEndpoint& endpoint() const { return *m_endpoint; }
  HostClients& clients() const { return *m_clients; }
  HostControls& controls() const { return *m_controls; }

  /// Tick the world 30 times a second until the game is over, a signal comes or an option says so; then send
  /// the players a goodbye and let what is queued drain. If the game does not return from a tick, and a
  /// signal comes, or if a second one does, the process ends from here, with a goodbye: with code 1, or by
  /// the signal.
  void run(df::World& world) override;
  /// End run() after the present tick, with this sentence to the players. Callable from another thread.
  void stop(const std::string& sentence);
  /// Call `job` on the host's thread, between two ticks. Callable from another thread (tests inspect a
  /// running world with it).
  void post(std::function<void(df::World&)> job);
  /// Called after every tick, on the host's thread.
  void setObserver(std::function<void(df::World&)> observer) { m_observer = std::move(observer); }

 private:
  using Clock = std::chrono::steady_clock;

  void beginGame(df::World& world);
  void endGame(df::World& world);
  void adoptSettings(df::World& world);
  void serveUntil(Clock::time_point deadline);
  bool isDue(TickClock& schedule);
  bool rests() const;
  TickClock rest();
  void tick(Watchdog& watchdog);
  void tickWorlds(Watchdog& watchdog);
  [[noreturn]] void endProcess(const ForcedEnd& end, SideLog& log);
  void flush();
  void sweep();
  void sayGoodbye();
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
  df::World* m_p_world = nullptr;
  Clock::time_point m_empty_since;
  Clock::time_point m_tick_began;
};

}  // namespace naiad
