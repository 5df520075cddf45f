// A host's part in a fleet: what runs the server (HostPlatform.h), and what it says to others (Bus.h). Losing
// either costs players nothing, and is seen in the counters.
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

/// On the host's thread. Nothing of it waits, but finish().
class HostFleet : public HostPart {
 public:
  /// What it works with outlives it.
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
  /// A link to another server of the fleet that has places, as the directory says; nothing: none is known.
  std::optional<JoinLink> linkToOther() const;
  /// A row that is about to be written. None twice.
  void publishScore(const ScoreRow& row, const std::string& game);
  void sayPlayers();
  Presence presence() const;
  void hearDirectory(Clock::time_point now);
  void takeNews();

  HostAccess m_access;
  std::unique_ptr<HostPlatform> m_platform;
  std::unique_ptr<Bus> m_bus;  ///< null: none
  std::string m_id;            ///< on the bus
  Clock::time_point m_said{};  ///< players, to the platform
  Clock::time_point m_present{};
  std::optional<SendOn> m_other;  ///< the newest that the directory has said
  Clock::time_point m_other_heard{};
};

}  // namespace naiad
