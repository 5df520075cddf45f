// The Agones platform: talks to the sidecar over HTTP on loopback, on its own thread. The requests are in
// AgonesRequestScheduler.h. If the sidecar is missing or answers nonsense, requests are retried.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "host/fleet/GameServerInfo.h"
#include "host/fleet/HostPlatform.h"

namespace naiad {

class AgonesPlatform : public HostPlatform {
 public:
  static constexpr std::uint16_t kDefaultPort = 9358;
  /// Timeout of a request with its response. For GET /watch/gameserver, only of connecting and sending.
  static constexpr std::chrono::seconds kRequestTimeout{2};

  /// `port`: the sidecar's port on 127.0.0.1; 0: the port in AGONES_SDK_HTTP_PORT, or else kDefaultPort.
  explicit AgonesPlatform(std::uint16_t port);
  ~AgonesPlatform() override;

  void notifyReady() override;
  void notifyTick(Clock::time_point now) override;
  void notifyPlayers(const PlatformPlayers& players) override;
  /// Tells the sidecar to shut the server down.
  void finish(std::chrono::milliseconds timeout) override;
  std::optional<PlatformAddress> address() const override;
  /// Returns true, once, if the watch reported that the server is being shut down.
  bool popShutdownRequest() override;
  std::string popLogMessage() override;
  PlatformCounters counters() const override;

 private:
  struct Loop;
  std::unique_ptr<Loop> m_loop;
};

}  // namespace naiad
