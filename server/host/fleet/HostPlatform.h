// What runs a server, as the server sees it: a service manager, a cluster, or none that wants to know. It is
// sent that the server is ready, that it ticks, who plays, and that it ends.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace naiad {

struct PlatformPlayers {
  std::string address;             ///< that the server listens on
  std::vector<std::uint32_t> ids;  ///< of those who play, cut-off ones among them; each once while it runs
  std::size_t most = 0;            ///< places
};

/// By which players reach the server.
struct PlatformAddress {
  std::string host;
  std::uint16_t port = 0;
};

struct PlatformCounters {
  std::uint64_t requests = 0;  ///< answered well
  std::uint64_t failures = 0;  ///< not, or not in time; tried again
  std::uint64_t health = 0;    ///< of the good ones: that said that the server ticks
};

/// The host's thread calls all of it; no call waits, but finish(). Losing the platform costs players nothing.
class HostPlatform {
 public:
  using Clock = std::chrono::steady_clock;

  virtual ~HostPlatform() = default;

  /// The server listens, or goes on after notifyReloading().
  virtual void notifyReady() = 0;
  /// The settings are read again.
  virtual void notifyReloading(Clock::time_point /*now*/) {}
  /// A tick has ended. A server that hangs does not come here, and is ended for it.
  virtual void notifyTick(Clock::time_point now) = 0;
  /// Once a second.
  virtual void notifyPlayers(const PlatformPlayers& players) = 0;
  /// The server takes no more players, and is about to end.
  virtual void notifyStopping() {}
  /// The last word, after the players' goodbyes: wait until it is said, at most so long. From any thread.
  virtual void finish(std::chrono::milliseconds /*patience*/) {}

  /// Nothing where the platform does not know.
  virtual std::optional<PlatformAddress> address() const { return std::nullopt; }
  /// Does the platform want the server to end? Once true.
  virtual bool takeEnd() { return false; }
  /// A line for the log, if there is news.
  virtual std::string takeNews() { return ""; }
  virtual PlatformCounters counters() const { return {}; }
};

/// None that wants to know.
class NoPlatform : public HostPlatform {
 public:
  void notifyReady() override {}
  void notifyTick(Clock::time_point /*now*/) override {}
  void notifyPlayers(const PlatformPlayers& /*players*/) override {}
};

}  // namespace naiad
