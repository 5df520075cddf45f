// systemd as a platform (ServiceNotify.h).
#pragma once

#include "host/fleet/HostPlatform.h"
#include "host/fleet/ServiceNotify.h"

namespace naiad {

class SystemdPlatform : public HostPlatform {
 public:
  SystemdPlatform() = default;
  /// For tests: as ServiceNotify.
  explicit SystemdPlatform(const ServiceNotify::Variable& variable) : m_service(variable) {}

  void notifyReady() override { m_service.notifyReady(); }
  void notifyReloading(Clock::time_point now) override { m_service.notifyReloading(now); }
  void notifyTick(Clock::time_point now) override { m_service.keepAlive(now); }
  void notifyPlayers(const PlatformPlayers& players) override {
    const std::size_t playing = players.ids.size();
    m_service.notifyStatus(players.address + ", " + std::to_string(playing) +
                           (playing == 1 ? " player" : " players"));
  }
  void notifyStopping() override { m_service.notifyStopping(); }

 private:
  ServiceNotify m_service;
};

}  // namespace naiad
