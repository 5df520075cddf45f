// Connects a host to the platform that runs it (HostPlatform.h) and to the fleet's bus (Bus.h). Losing either
// does not affect players, and shows in the counters.
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>

#include "host/fleet/Bus.h"
#include "host/fleet/HostPlatform.h"
#include "host/loop/HostPart.h"
#include "host/ops/HostScores.h"
#include "host/rooms/HostContext.h"
#include "shared/fleet/BusPayloads.h"

namespace naiad {

/// Thread: the host's. Only finish() blocks.
class HostFleet : public HostPart {
 public:
  /// The arguments must outlive it.
  HostFleet(const HostAccess& access, HostScores& scores);
  ~HostFleet() override;

  void begin() override;
  void tick(Clock::time_point now) override;
  void drain() override;
  void finish() override;

 private:
  std::chrono::milliseconds interval() const {
    return std::chrono::milliseconds(m_access.context.options.bus_interval_ms);
  }
  /// Returns the link to another server with free places, from the directory's newest redirect; nullopt
  /// without one, or if it is too old.
  std::optional<JoinLink> redirectLink() const;
  /// Publishes a score row that is about to be written. Called once per row.
  void publishScore(const ScoreRow& row, const std::string& game);
  void reportPlayers();
  Presence presence() const;
  void processRedirects(Clock::time_point now);
  void popLogMessage();

  HostAccess m_access;
  std::unique_ptr<HostPlatform> m_platform;
  std::unique_ptr<Bus> m_bus;                 ///< null: no bus
  std::string m_id;                           ///< name on the bus
  Clock::time_point m_players_reported_at{};  ///< last report of players to the platform
  Clock::time_point m_presence_sent_at{};
  std::optional<Redirect> m_redirect;  ///< newest redirect from the directory
  Clock::time_point m_redirect_received_at{};
};

}  // namespace naiad
