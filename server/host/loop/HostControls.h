// Controls of a running host: end it, restart it, continue its round in a new program, reload its options.
// Used by signals, commands and the platform that runs the server.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <thread>

#include "host/auth/PasswordHash.h"
#include "host/auth/ServerIdentity.h"
#include "host/process/ShutdownScheduler.h"
#include "host/process/StopSignals.h"
#include "host/settings/HostOptions.h"

namespace naiad {

struct HostContext;
class HostClients;
class HostEndpoint;
class RoundHandover;

/// Reloaded options, and values that are slow to compute from them.
struct ReloadResult {
  std::string problem;  ///< why the options cannot be used; empty if they can
  HostOptions options;
  std::optional<PasswordHash> password;    ///< hash of a changed password
  std::optional<ServerIdentity> identity;  ///< from --certificate and --key, whose files may be new
};

/// Rereads a running server's options, on its own thread, because files may be slow and hashing takes 0.1 s.
class Reload {
 public:
  /// Throws an exception that says why the options cannot be read.
  using ReadOptions = std::function<HostOptions()>;

  explicit Reload(ReadOptions read) : m_read(std::move(read)) {}
  /// Waits for a running reload.
  ~Reload();

  /// Starts a reload from `now`, the options in force. Calls `done` once, on the reload thread. False if a
  /// reload is already running.
  bool begin(const HostOptions& now, std::function<void(ReloadResult)> done);

 private:
  ReadOptions m_read;
  std::thread m_thread;
  std::atomic<bool> m_reading = false;
};

/// Thread: the host's.
class HostControls {
 public:
  using Clock = std::chrono::steady_clock;
  /// Called once on the host's thread with a request's result: success, and a sentence without full stop.
  using Done = std::function<void(bool is_done, const std::string& sentence)>;

  /// All arguments must outlive this.
  HostControls(HostContext& context, HostEndpoint& endpoint, HostClients& clients)
      : m_context(context), m_endpoint(endpoint), m_clients(clients) {}

  /// Plans the end of Host::run(). With private worlds or named rooms, at_round_end is treated as when_empty.
  void end(ShutdownScheduler::Plan plan);
  /// Plans the end when no players are left, or after this many seconds.
  void endWhenEmpty(double seconds);
  /// Cancels a planned end. False if none was planned.
  bool cancelEnd();
  /// Call once a tick: tells players about a planned end, and plans a restart if the program was upgraded.
  void update(Clock::time_point now);
  /// Reacts to signals. The first SIGTERM gives players drain_time to finish; a second signal ends everything
  /// at once (Watchdog.h). SIGHUP without a terminal reopens the log and reloads the options.
  void handleSignals(StopSignals& signals);

  void setReload(Reload::ReadOptions read) { m_reload.emplace(std::move(read)); }
  /// Reads the options again and applies those that may change while the server runs. Reading and password
  /// hashing run on another thread. If the options are invalid or need a restart, the present values stay.
  void reload(Done done);
  /// Sets a function called when SIGHUP starts a reload (`is_done` false) and when it has finished (true).
  void setOnReload(std::function<void(bool is_done, Clock::time_point now)> on_reload) {
    m_on_reload = std::move(on_reload);
  }
  /// Sets a function called before the process is forced to exit (ForcedExit in Watchdog.h). It runs on the
  /// watchdog's thread and may block for `timeout`. Call before Host::run().
  void setOnForcedExit(std::function<void(std::chrono::milliseconds timeout)> on_forced_exit) {
    m_on_forced_exit = std::move(on_forced_exit);
  }
  void reportForcedExit(std::chrono::milliseconds timeout) const {
    if (m_on_forced_exit) m_on_forced_exit(timeout);
  }
  /// Applies the changed options that may change while the server runs: applyReloadable() (HostOptions.h).
  OptionChanges applyOptions(const HostOptions& options);

  /// Sets the object that handOverRound() uses; it must outlive this.
  void setHandover(RoundHandover& handover) { m_p_handover = &handover; }
  /// Replays the round in the installed program as a trial, then restarts in that program, which continues
  /// the round. If the trial fails, the server restarts without the round when all players have left. If the
  /// trial cannot start, or the round cannot be handed over afterwards, nothing changes. Then calls `done`.
  void handOverRound(Done done);
  /// True if Host::run() has ended, or is about to end, so that another program continues the round.
  bool handsOverRound() const;
  /// Call after the last tick. Ignores a running trial replay; stops writing a round that is handed over.
  void beginDrain();

 private:
  void restartForUpgrade(Clock::time_point now);
  void applyReloaded(ReloadResult reloaded, const Done& done);
  std::string handoverBlocker() const;
  void finishVerification(const std::string& problem, const Done& done);
  void endWithoutRound(const std::string& problem, const Done& done);

  HostContext& m_context;
  HostEndpoint& m_endpoint;
  HostClients& m_clients;
  std::optional<Reload> m_reload;
  std::function<void(bool, Clock::time_point)> m_on_reload;
  std::function<void(std::chrono::milliseconds)> m_on_forced_exit;
  RoundHandover* m_p_handover = nullptr;  ///< null: rounds cannot be handed over
  bool m_hands_over_round = false;
  bool m_is_draining = false;
  int m_handled_signals = 0;
};

}  // namespace naiad
