// What servers of a fleet say to each other: presence, and results of games. Losing it costs players nothing.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "shared/fleet/BusPayloads.h"

namespace naiad {

struct BusMessage {
  std::string subject;
  std::string payload;
  std::string id = {};  ///< it is kept until it has arrived, and there is one of each; empty: it may be lost
};

struct BusCounters {
  std::uint64_t published = 0;    ///< given to the bus
  std::uint64_t dropped = 0;      ///< the oldest of too many that waited
  std::uint64_t failures = 0;     ///< tried again
  std::uint64_t connections = 0;  ///< more than one: the bus was lost and came back
  std::uint64_t received = 0;     ///< of the subjects asked for
  std::uint64_t ignored = 0;      ///< of these: too long, or of too many subjects
};

class Bus {
 public:
  /// Waiting for the bus, at most.
  static constexpr std::size_t kMaxKept = 4096;
  static constexpr std::size_t kMaxFleeting = 1024;

  virtual ~Bus() = default;

  /// Never waits. Any thread.
  virtual void publish(BusMessage message) = 0;
  virtual bool isConnected() const = 0;
  /// What came since the last call, of each subject the newest (BusQueue.h). It is as others wrote it.
  virtual std::vector<BusMessage> takeMessages() = 0;
  /// Wait until what is kept has arrived, at most so long.
  virtual void finish(std::chrono::milliseconds patience) = 0;
  virtual BusCounters counters() const = 0;
  /// A line for the log, if there is news.
  virtual std::string takeNews() = 0;
};

/// NATS, by libnats. The settings have no complaint.
std::unique_ptr<Bus> connectBus(const BusSettings& settings);

}  // namespace naiad
