// A host's part in a fleet: what runs the server (HostPlatform.h), and what it says to others (Bus.h). Losing
// either costs players nothing, and is seen in the counters.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "host/fleet/Bus.h"
#include "host/fleet/HostPlatform.h"
#include "host/net/NetworkThread.h"
#include "host/rooms/Rooms.h"
#include "host/rooms/SessionTable.h"
#include "host/scores/ScoreKeeper.h"
#include "host/session/Counters.h"
#include "host/settings/HostOptions.h"
#include "shared/fleet/Presence.h"
#include "shared/fleet/SendOn.h"
#include "shared/program/LineLog.h"

namespace naiad {

/// On the host's thread, but sayLast(). Nothing of it waits, but finish() and sayLast().
class HostFleet {
 public:
  using Clock = std::chrono::steady_clock;

  /// All of these outlive it.
  struct Setup {
    const HostOptions& options;
    const SessionTable& sessions;
    const NetworkThread& network;
    Counters& counters;
    std::string game;
    std::string key;  ///< of the server, as its fingerprint; empty: without encryption
    LogLine log;
    std::function<bool()> is_open;  ///< does it let players in?
    std::function<std::vector<PresenceRoom>()> rooms;
    std::function<void()> end;  ///< the platform wants the server to end
  };
  explicit HostFleet(Setup setup);
  ~HostFleet();
  HostFleet(const HostFleet&) = delete;
  HostFleet& operator=(const HostFleet&) = delete;

  /// The server listens.
  void begin();
  /// The settings are read again; begin() ends it.
  void noteReloading(Clock::time_point now) { m_platform->notifyReloading(now); }
  /// Once a tick, at its end.
  void tick(Clock::time_point now);
  /// A link to another server of the fleet that has places, as the directory says; nothing: none is known.
  std::optional<JoinLink> linkToOther(Clock::time_point now) const;
  /// A row that is about to be written. None twice.
  void noteScore(const ScoreRow& row, const std::string& game);
  /// The server is about to end: players' goodbyes come next.
  void noteStopping();
  /// After them.
  void finish();
  /// As finish(), where the host's thread hangs. From any thread.
  void sayLast(std::chrono::milliseconds patience) { m_platform->finish(patience); }

 private:
  std::chrono::milliseconds interval() const {
    return std::chrono::milliseconds(m_setup.options.bus_interval_ms);
  }
  void sayPlayers();
  Presence presence() const;
  void hearDirectory(Clock::time_point now);
  void takeNews();

  Setup m_setup;
  std::unique_ptr<HostPlatform> m_platform;
  std::unique_ptr<Bus> m_bus;  ///< null: none
  std::string m_id;            ///< on the bus
  Clock::time_point m_said{};  ///< players, to the platform
  Clock::time_point m_present{};
  std::optional<SendOn> m_other;  ///< the newest that the directory has said
  Clock::time_point m_other_heard{};
};

/// The rooms of a server, where they have names.
std::vector<PresenceRoom> presenceOfRooms(const Rooms& rooms);

}  // namespace naiad
