// What can be asked of a running host: to end, to begin again, to go on with its round in another program, to
// read its options again. Signals ask, and so do commands and what runs the server.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <thread>

#include "host/auth/PasswordHash.h"
#include "host/auth/ServerIdentity.h"
#include "host/process/Ending.h"
#include "host/process/StopSignals.h"
#include "host/settings/HostOptions.h"

namespace naiad {

struct HostContext;
class HostClients;
class HostEndpoint;
class RoundHandover;

/// What was read, and what takes time to make of it.
struct Reloaded {
  std::string problem;  ///< why nothing can be made of it; empty: it is good
  HostOptions options;
  std::optional<PasswordHash> password;    ///< of a password that has changed
  std::optional<ServerIdentity> identity;  ///< of --certificate and --key: the files may be new
};

/// Reads a running server's options again. Files may be slow, and a password takes 0.1 s to hash: both happen
/// on a thread of its own.
class Reload {
 public:
  /// Throws what says why it cannot.
  using ReadOptions = std::function<HostOptions()>;

  explicit Reload(ReadOptions read) : m_read(std::move(read)) {}
  /// Waits for what has begun.
  ~Reload();

  /// Read them, and call `done` once, on the other thread. `now`: the options in force. False: what was begun
  /// earlier is not done.
  bool begin(const HostOptions& now, std::function<void(Reloaded)> done);

 private:
  ReadOptions m_read;
  std::thread m_thread;
  std::atomic<bool> m_reading = false;
};

/// On the host's thread.
class HostControls {
 public:
  using Clock = std::chrono::steady_clock;
  /// What became of a request, once, on the host's thread: whether it is done, and a sentence without its
  /// end.
  using Done = std::function<void(bool is_done, const std::string& sentence)>;

  /// All of these outlive it.
  HostControls(HostContext& context, HostEndpoint& endpoint, HostClients& clients)
      : m_context(context), m_endpoint(endpoint), m_clients(clients) {}

  /// Host::run() ends so; at the end of a round, where each player has a world of their own, is when all have
  /// left.
  void end(Ending::Plan plan);
  /// The same as soon as no players are left, or after so long.
  void endWhenEmpty(double seconds);
  /// Do not end after all. False: nothing was planned.
  bool cancelEnd();
  /// Once a tick: what players should know of the end, and a program that was upgraded.
  void update(Clock::time_point now);
  /// Do what signals ask for. The first SIGTERM lets players finish, if there is time for that; a second
  /// signal ends all (Watchdog.h). SIGHUP without a terminal reads the options again.
  void heedSignals(StopSignals& signals);

  void setReload(Reload::ReadOptions read) { m_reload.emplace(std::move(read)); }
  /// Read the options again, and take over what may change while the server runs. Files are read and
  /// passwords hashed on a thread of their own. Options that cannot be used, and those that need a restart,
  /// leave what there was.
  void reload(Done done);
  /// SIGHUP was heeded: `is_done` false, and once the options are read, true.
  void watchReloads(std::function<void(bool is_done, Clock::time_point now)> on_reload) {
    m_on_reload = std::move(on_reload);
  }
  /// The process is ended without the game, which hangs. It is called on the watchdog's thread, and may wait
  /// so long. Before Host::run().
  void watchForcedEnd(std::function<void(std::chrono::milliseconds patience)> on_forced_end) {
    m_on_forced_end = std::move(on_forced_end);
  }
  void announceForcedEnd(std::chrono::milliseconds patience) const {
    if (m_on_forced_end) m_on_forced_end(patience);
  }
  /// Some of these have changed, of which takeOver() (HostOptions.h) takes those that may.
  OptionChanges adopt(const HostOptions& options);

  /// What keepRound() works with; outlives this.
  void setHandover(RoundHandover& handover) { m_p_handover = &handover; }
  /// Begin again in the program that is installed by now, with the round that is being played. `done` is
  /// called once that has been tried out. If it cannot be, the server begins again when all have left; or
  /// nothing has changed, for there is no round to try it with.
  void keepRound(Done done);
  /// Host::run() has ended, or is about to, so that another program goes on with the round.
  bool keepsRound() const;
  /// No more ticks: what a proof finds out comes too late, and the round that is kept is written no further.
  void beginDrain();

 private:
  void heedUpgrade(Clock::time_point now);
  void adoptReloaded(Reloaded reloaded, const Done& done);
  std::string whyNotKept() const;
  void finishProof(const std::string& problem, const Done& done);
  void endWithoutRound(const std::string& problem, const Done& done);

  HostContext& m_context;
  HostEndpoint& m_endpoint;
  HostClients& m_clients;
  std::optional<Reload> m_reload;
  std::function<void(bool, Clock::time_point)> m_on_reload;
  std::function<void(std::chrono::milliseconds)> m_on_forced_end;
  RoundHandover* m_p_handover = nullptr;  ///< null: no round can be kept
  bool m_keeps_round = false;
  bool m_is_draining = false;
  int m_heeded_signals = 0;
};

}  // namespace naiad
