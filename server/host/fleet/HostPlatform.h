// The interface to the platform that runs a server: a service manager, a cluster, or none. The server reports
// that it is ready, that it ticks, its players, and its end.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace naiad {

struct PlatformPlayers {
  std::string address;             ///< address on which the server listens
  std::vector<std::uint32_t> ids;  ///< player ids, including detached players; never reused by a server
  std::size_t most = 0;            ///< maximum number of players
};

/// The public address of the server.
struct PlatformAddress {
  std::string host;
  std::uint16_t port = 0;
};

struct PlatformCounters {
  std::uint64_t requests = 0;  ///< successful requests
  std::uint64_t failures = 0;  ///< failed or timed-out requests; they are retried
  std::uint64_t health = 0;    ///< successful requests that reported health
};

/// Thread: the host's, except for finish(). Only finish() blocks. Losing the platform does not affect
/// players. This class itself ignores all reports, for a server without a platform.
class HostPlatform {
 public:
  using Clock = std::chrono::steady_clock;

  virtual ~HostPlatform() = default;

  /// Reports that the server listens, or that a reload is done.
  virtual void notifyReady() {}
  /// Reports that the settings are being reloaded.
  virtual void notifyReloading(Clock::time_point /*now*/) {}
  /// Reports a tick that has ended, begun at `now`. The platform may end a server that reports none.
  virtual void notifyTick(Clock::time_point /*now*/) {}
  /// Reports the players. Called once a second.
  virtual void notifyPlayers(const PlatformPlayers& /*players*/) {}
  /// Reports that the server accepts no more players and is about to end.
  virtual void notifyStopping() {}
  /// Reports the end after the players' goodbyes. Waits for `timeout` at most until it is sent. Any thread.
  virtual void finish(std::chrono::milliseconds /*timeout*/) {}

  /// Returns nullopt if the platform does not know the address.
  virtual std::optional<PlatformAddress> address() const { return std::nullopt; }
  /// Returns true, once, if the platform asks the server to end.
  virtual bool popShutdownRequest() { return false; }
  /// Returns a new log line, or "".
  virtual std::string popLogMessage() { return ""; }
  virtual PlatformCounters counters() const { return {}; }
};

}  // namespace naiad
