// The message bus of a fleet, for presence and game results. Losing it does not affect players.
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
  std::string id = {};  ///< makes delivery reliable, with duplicates removed; empty: the message may be lost
};

struct BusCounters {
  std::uint64_t published = 0;    ///< messages passed to the bus
  std::uint64_t dropped = 0;      ///< oldest messages dropped because too many waited
  std::uint64_t failures = 0;     ///< failed attempts to connect or publish
  std::uint64_t connections = 0;  ///< successful connects; more than 1 if the bus was lost and came back
  std::uint64_t received = 0;     ///< messages of the subscribed subjects
  std::uint64_t ignored = 0;  ///< received messages that were too long, or of a new subject beyond the limit
  std::uint64_t lost = 0;     ///< messages lost before they were received, of any sender: too many waited
};

class Bus {
 public:
  /// Maximum numbers of reliable and of other messages waiting for the bus; beyond it, the oldest is dropped.
  static constexpr std::size_t kMaxReliable = 4096;
  static constexpr std::size_t kMaxBestEffort = 1024;

  virtual ~Bus() = default;

  /// Queues a message. Never blocks. Any thread.
  virtual void publish(BusMessage message) = 0;
  virtual bool isConnected() const = 0;
  /// Returns the newest message of each subject since the last call (BusQueue.h). The contents are untrusted.
  virtual std::vector<BusMessage> popMessages() = 0;
  /// Waits until all queued messages are sent or the bus is lost, for `timeout` at most.
  virtual void finish(std::chrono::milliseconds timeout) = 0;
  virtual BusCounters counters() const = 0;
  /// Returns a new log line, or "".
  virtual std::string popLogMessage() = 0;
};

/// Maximum number of arrived messages of a subscription that wait to be received; further ones are lost.
inline constexpr int kMaxBusPending = 65'536;

/// Connects to a NATS server with libnats. The settings must be valid (validateBusSettings()).
std::unique_ptr<Bus> connectBus(const BusSettings& settings, int max_pending = kMaxBusPending);

}  // namespace naiad
