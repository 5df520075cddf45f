// Agones as a platform: talks to the sidecar that stands beside the server, over HTTP on loopback, on a
// thread of its own (SidecarDuties.h says what). A sidecar that is not there yet, is gone, or answers
// nonsense is tried again, and costs players nothing.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "host/fleet/GameServerFacts.h"
#include "host/fleet/HostPlatform.h"

namespace naiad {

class AgonesPlatform : public HostPlatform {
 public:
  static constexpr std::uint16_t kDefaultPort = 9358;
  /// For an answer, and for the line that ends a watch that has begun none.
  static constexpr std::chrono::seconds kPatience{2};

  /// The sidecar's port on 127.0.0.1; 0: as AGONES_SDK_HTTP_PORT says, else kDefaultPort.
  explicit AgonesPlatform(std::uint16_t port);
  ~AgonesPlatform() override;

  void notifyReady() override;
  void notifyTick(Clock::time_point now) override;
  void notifyPlayers(const PlatformPlayers& players) override;
  /// Says that the server ends.
  void finish(std::chrono::milliseconds patience) override;
  std::optional<PlatformAddress> address() const override;
  /// The watch said that the server is being shut down.
  bool takeEnd() override;
  std::string takeNews() override;
  PlatformCounters counters() const override;

 private:
  struct Loop;
  std::unique_ptr<Loop> m_loop;
};

}  // namespace naiad
