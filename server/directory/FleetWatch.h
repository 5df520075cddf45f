// Keeps the list of a fleet's servers by what the bus brings.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "host/fleet/Bus.h"
#include "server/directory/FleetList.h"
#include "shared/net/base/TokenBucket.h"

namespace naiad {

/// Not thread-safe. Time is passed in.
class FleetWatch {
 public:
  using Time = FleetList::Time;

  /// While the bus is gone the list stays as it was, for so long: the servers play on, and players still find
  /// them.
  static constexpr std::chrono::minutes kBlind{10};
  /// Lines about servers that come and go: names may come from a server that only pretends.
  static constexpr BucketRate kNewsRate{5, 100};

  /// `bus` listens to presence. `log`: a line for people. `interval`: as FleetList's.
  FleetWatch(std::unique_ptr<Bus> bus, std::function<void(const std::string& line)> log, Time now,
             std::chrono::milliseconds interval = Presence::kInterval);

  /// Some times a second.
  void update(Time now);

  FleetList& servers() { return m_servers; }
  const FleetList& servers() const { return m_servers; }
  Bus& bus() { return *m_bus; }

 private:
  void logNews(const std::string& line, Time now);

  std::unique_ptr<Bus> m_bus;
  std::function<void(const std::string& line)> m_log;
  FleetList m_servers;
  Time m_connected_at;
  TokenBucket m_news;
  std::uint64_t m_news_left_out = 0;
};

}  // namespace naiad
